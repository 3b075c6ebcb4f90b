#include "io/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace pointreel::io {
namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (is_open()) ::close(descriptor_);
  }

  bool is_open() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  // False when the system reports late that the bytes could not be stored.
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

Error system_error(const std::filesystem::path& path, std::string_view action) {
  const std::string reason = std::generic_category().message(errno);
  return {ErrorCode::io_error, path.string() + ": cannot " + std::string(action) + ": " + reason};
}

bool write_all(FileDescriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return file.close();
}

// In the target's folder, as a rename cannot cross file systems. Short, so that it fits where the target
// fits.
std::filesystem::path temporary_path_beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter = 0;
  return path.parent_path() /
         (".pointreel-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path) {
  // Without O_NONBLOCK opening a named pipe would wait for a writer.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.is_open()) return system_error(path, "open");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return system_error(path, "read");
  if (!S_ISREG(status.st_mode)) return Error{ErrorCode::io_error, path.string() + ": is not a regular file"};
  const auto size_bytes = static_cast<std::uintmax_t>(status.st_size);
  if (size_bytes > max_file_bytes) {
    return Error{ErrorCode::resource_limit, path.string() + ": has " + std::to_string(size_bytes) +
                                                " bytes, more than the limit of " +
                                                std::to_string(max_file_bytes) + " for one sweep"};
  }

  std::string bytes(size_bytes, '\0');
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t count = ::read(file.get(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error(path, "read");
    if (count == 0) break;  // cut short by someone else meanwhile: the parser judges what is there
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  return bytes;
}

Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  // A rename would replace a device such as /dev/null by a file.
  std::error_code ignored;
  const auto target = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(target) && !std::filesystem::is_regular_file(target)) {
    return Error{ErrorCode::io_error, path.string() + ": cannot write: is not a regular file"};
  }

  std::filesystem::path temporary;
  int descriptor = -1;
  do {  // a killed process with the same number may have left its file behind
    temporary = temporary_path_beside(path);
    descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EEXIST);
  FileDescriptor file(descriptor);
  if (!file.is_open()) return system_error(path, "write");
  if (!write_all(file, bytes) || ::rename(temporary.c_str(), path.c_str()) != 0) {
    const Error error = system_error(path, "write");
    ::unlink(temporary.c_str());
    return error;
  }
  return {};
}

}  // namespace pointreel::io
