// Whole files in and out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "pointreel/result.h"

namespace pointreel::io {

// Far above any sweep (a 4 GiB KITTI file has 268 million points); keeps a wrong argument from eating all
// memory.
inline constexpr std::uintmax_t max_file_bytes = std::uintmax_t{4} << 30;

// Errors: io_error (not there, not a regular file, unreadable), resource_limit (over 4 GiB).
Result<std::string> read_file(const std::filesystem::path& path);

// Writes beside `path` under a temporary name and renames it, so that nobody ever sees half a file; the
// temporary file is removed on failure. Not synced to disk: this guards against errors and kills, not against
// power cuts.
Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace pointreel::io
