#include "pointreel/sweep_stream.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "io/cloud_stream.h"
#include "io/formats.h"

namespace pointreel {
namespace {

// More would only be late: the sender waits instead.
constexpr std::size_t kMostWaiting = 4;
constexpr std::size_t kChunkBytes = 1 << 20;

std::string name_of_sweep(std::size_t number) {
  return fmt::format("standard input, sweep {}", number);
}

}  // namespace

SweepStream::SweepStream(const StopEvent& stop) : stop_(stop), thread_([this] { receive(); }) {}

SweepStream::~SweepStream() {
  stop_.request();
  const std::lock_guard lock(mutex_);
  abandoned_ = true;
  changed_.notify_all();
}

std::optional<ArrivedSweep> SweepStream::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !waiting_.empty() || ended_; });
  if (waiting_.empty()) return {};
  Received received = std::move(waiting_.front());
  waiting_.pop_front();
  const std::string name = name_of_sweep(taken_count_++);
  changed_.notify_all();
  lock.unlock();
  if (received.error) return ArrivedSweep{name, *received.error, received.arrived};
  auto cloud = received.format == CloudFormat::ply ? io::parse_ply(received.bytes, name)
                                                   : io::parse_pcd(received.bytes, name);
  return ArrivedSweep{name, std::move(cloud), received.arrived};
}

void SweepStream::receive() {
  std::string buffer;
  std::array<pollfd, 2> waited_for = {{{STDIN_FILENO, POLLIN, 0}, {stop_.descriptor(), POLLIN, 0}}};
  for (;;) {
    if (::poll(waited_for.data(), waited_for.size(), -1) < 0 && errno != EINTR) break;
    if (waited_for[1].revents != 0) break;
    if (waited_for[0].revents == 0) continue;
    const std::size_t before = buffer.size();
    buffer.resize(before + kChunkBytes);
    const ssize_t count = ::read(STDIN_FILENO, buffer.data() + before, kChunkBytes);
    buffer.resize(before + static_cast<std::size_t>(count > 0 ? count : 0));
    if (count < 0 && errno == EINTR) continue;
    const std::string name = name_of_sweep(received_count_);
    if (count < 0) {
      const std::string message =
          fmt::format("{}: cannot read: {}", name, std::generic_category().message(errno));
      push({{}, {}, Error{ErrorCode::io_error, message}, ArrivalClock::now()});
      break;
    }
    if (!cut_sweeps(buffer)) break;
    if (count > 0) continue;
    if (!buffer.empty()) {
      push({{},
            {},
            Error{ErrorCode::truncated,
                  fmt::format("{}: the stream ends within it, after {} bytes", name, buffer.size())},
            ArrivalClock::now()});
    }
    break;
  }
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

// Takes the whole sweeps off the front. False when no one can tell where the next one would start.
bool SweepStream::cut_sweeps(std::string& buffer) {
  for (;;) {
    const auto leading = io::leading_cloud(buffer, name_of_sweep(received_count_));
    if (!leading) {
      push({{}, {}, leading.error(), ArrivalClock::now()});
      return false;
    }
    if (!*leading || (*leading)->bytes > buffer.size()) return true;
    push({buffer.substr(0, (*leading)->bytes), (*leading)->format, {}, ArrivalClock::now()});
    buffer.erase(0, (*leading)->bytes);
  }
}

void SweepStream::push(Received received) {
  ++received_count_;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kMostWaiting || abandoned_; });
  waiting_.push_back(std::move(received));
  changed_.notify_all();
}

}  // namespace pointreel
