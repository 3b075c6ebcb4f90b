#include "pointreel/folder_watch.h"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

#include "pointreel/io.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kSettledAfter{1};
constexpr milliseconds kLookAgainAfter{100};

bool is_sweep_name(const std::string& name) {
  return !name.empty() && name[0] != '.' && guess_cloud_format(name);
}

// A link appears whole, and no one will close it.
bool is_link(const fs::path& path) {
  std::error_code gone;
  return fs::is_symlink(fs::symlink_status(path, gone)) || fs::hard_link_count(path, gone) > 1;
}

}  // namespace

bool FolderWatch::NaturalOrder::operator()(const std::string& a, const std::string& b) const {
  return natural_less(a, b);
}

Result<std::unique_ptr<FolderWatch>> FolderWatch::create(const fs::path& folder, std::optional<double> idle_s,
                                                         const StopEvent& stop) {
  const int inotify = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
  constexpr std::uint32_t kEvents =
      IN_CREATE | IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_DELETE_SELF | IN_ONLYDIR;
  if (inotify < 0 || ::inotify_add_watch(inotify, folder.c_str(), kEvents) < 0) {
    const std::string reason = std::generic_category().message(errno);
    if (inotify >= 0) ::close(inotify);
    return Error{ErrorCode::io_error, "--follow: cannot watch folder '" + folder.string() + "': " + reason};
  }
  return std::unique_ptr<FolderWatch>(new FolderWatch(folder, idle_s, stop, inotify));
}

FolderWatch::FolderWatch(fs::path folder, std::optional<double> idle_s, const StopEvent& stop, int inotify)
    : folder_(std::move(folder)),
      idle_s_(idle_s),
      stop_(stop),
      inotify_(inotify),
      last_change_(ArrivalClock::now()),
      thread_([this] { watch(); }) {}

FolderWatch::~FolderWatch() {
  stop_.request();
  thread_.join();
  ::close(inotify_);
}

std::optional<ArrivedSweep> FolderWatch::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_ || (!files_.empty() && files_.begin()->second.complete); });
  const auto first =
      std::find_if(files_.begin(), files_.end(), [](const auto& file) { return file.second.complete; });
  if (first == files_.end()) return {};
  const fs::path path = folder_ / first->first;
  const auto arrived = first->second.arrived;
  files_.erase(first);
  lock.unlock();
  return ArrivedSweep{path.string(), read_cloud(path), arrived};
}

void FolderWatch::watch() {
  take_what_is_there();
  std::array<pollfd, 2> waited_for = {{{inotify_, POLLIN, 0}, {stop_.descriptor(), POLLIN, 0}}};
  for (bool goes_on = true; goes_on;) {
    milliseconds wait = any_settles() ? kLookAgainAfter : milliseconds(-1);
    if (idle_s_) {
      const auto idle = std::chrono::duration<double>(ArrivalClock::now() - last_change_);
      const auto left = milliseconds(static_cast<std::int64_t>(std::ceil(1000 * (*idle_s_ - idle.count()))));
      if (left.count() <= 0) break;
      wait = wait.count() < 0 ? left : std::min(wait, left);
    }
    if (::poll(waited_for.data(), waited_for.size(), static_cast<int>(wait.count())) < 0 && errno != EINTR)
      break;
    if (waited_for[1].revents != 0) break;
    goes_on = take_events();
    look_at_settling();
  }
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

// False when the folder itself is gone.
bool FolderWatch::take_events() {
  alignas(inotify_event) std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t bytes = ::read(inotify_, buffer.data(), buffer.size());
    if (bytes <= 0) return true;  // no more for now
    for (ssize_t offset = 0; offset < bytes;) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + offset, sizeof(event));
      const char* name = buffer.data() + offset + sizeof(event);
      offset += static_cast<ssize_t>(sizeof(event) + event.len);
      if ((event.mask & (IN_DELETE_SELF | IN_IGNORED)) != 0) return false;
      if ((event.mask & IN_Q_OVERFLOW) != 0) take_what_is_there();
      if (event.len != 0) take_event(event.mask, name);
    }
  }
}

void FolderWatch::take_event(std::uint32_t mask, const std::string& name) {
  if (!is_sweep_name(name) || (mask & IN_ISDIR) != 0) return;
  const auto now = ArrivalClock::now();
  const std::lock_guard lock(mutex_);
  const auto known = files_.find(name);
  if ((mask & (IN_DELETE | IN_MOVED_FROM)) != 0) {
    if (known == files_.end()) return;
    if (!known->second.complete) seen_.erase(name);
    files_.erase(known);
  } else if (known == files_.end()) {
    if (!seen_.insert(name).second) return;  // was given already
    const bool complete = (mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0 || is_link(folder_ / name);
    files_[name] = {complete, now, false, {}, {}};
    last_change_ = now;
  } else if ((mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0 && !known->second.complete) {
    known->second = {true, now, false, {}, {}};
    last_change_ = now;
  }
  changed_.notify_all();
}

// The files that no event tells of: those from before the watch, or all of them when events were lost.
void FolderWatch::take_what_is_there() {
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code no_status;
    if (!is_sweep_name(name) || !entry->is_regular_file(no_status)) continue;
    const std::lock_guard lock(mutex_);
    if (!seen_.insert(name).second) continue;
    File file;
    file.settles = true;
    file.written = fs::last_write_time(entry->path(), no_status);
    file.unchanged_since = ArrivalClock::now();
    // Long ago; what is from the future may still be changing.
    if (const auto age = fs::file_time_type::clock::now() - file.written; age > kSettledAfter) {
      file.settles = false;
      file.complete = true;
    }
    files_[name] = file;
    changed_.notify_all();
  }
}

void FolderWatch::look_at_settling() {
  const auto now = ArrivalClock::now();
  const std::lock_guard lock(mutex_);
  for (auto& [name, file] : files_) {
    if (!file.settles) continue;
    std::error_code gone;
    if (const auto written = fs::last_write_time(folder_ / name, gone); written != file.written) {
      file.written = written;
      file.unchanged_since = last_change_ = now;
    } else if (now - file.unchanged_since > kSettledAfter) {
      file.settles = false;
      file.complete = true;
      last_change_ = now;
      changed_.notify_all();
    }
  }
}

bool FolderWatch::any_settles() {
  const std::lock_guard lock(mutex_);
  return std::any_of(files_.begin(), files_.end(), [](const auto& file) { return file.second.settles; });
}

}  // namespace pointreel
