// Runs codecs that are programs found on PATH. Their files are in memory (/dev/shm) where there is that.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "codecs/codec.h"

namespace pointreel {

std::optional<std::filesystem::path> find_program(const std::string& name);

// Waits for its end; what it says goes to nowhere. Returns the largest memory it had in KiB. Error: it cannot
// be started, or ended with another code than 0.
Result<std::size_t> run_program(const std::filesystem::path& program,
                                const std::vector<std::string>& arguments);

// A folder of its own that is gone with the object.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

Result<Bytes> read_bytes(const std::string& path);
Result<void> write_bytes(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace pointreel
