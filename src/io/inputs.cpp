// From the user's arguments to cloud files in natural order.
#include <glob.h>

#include <algorithm>
#include <array>
#include <new>
#include <system_error>

#include "pointreel/io.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;

using Paths = std::vector<fs::path>;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Cuts the digits at the front of `text` off and gives them without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto length =
      static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
  std::string_view digits = text.substr(0, length);
  text.remove_prefix(length);
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

void sort_naturally(Paths& paths) {
  std::sort(paths.begin(), paths.end(),
            [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
}

// The visible cloud files right in `folder`; none when it is no folder.
Result<Paths> cloud_files_in(const fs::path& folder) {
  Paths files;
  std::error_code error;
  if (!fs::is_directory(folder, error)) return files;
  fs::directory_iterator it(folder, error);
  for (; !error && it != fs::directory_iterator(); it.increment(error)) {
    const bool is_hidden = it->path().filename().native().starts_with('.');
    std::error_code no_status;  // a dangling link is no cloud file
    if (!is_hidden && it->is_regular_file(no_status) && guess_cloud_format(it->path())) {
      files.push_back(it->path());
    }
  }
  if (error) {
    return Error{ErrorCode::io_error, "cannot list folder '" + folder.string() + "': " + error.message()};
  }
  sort_naturally(files);
  return files;
}

Result<Paths> expand_folder(const std::string& folder) {
  // Where KITTI odometry, KITTI raw and other data sets keep their sweeps.
  constexpr std::array<std::string_view, 4> subfolders = {"", "velodyne", "velodyne_points/data", "data"};
  for (const std::string_view subfolder : subfolders) {
    auto files = cloud_files_in(subfolder.empty() ? fs::path(folder) : fs::path(folder) / subfolder);
    if (!files || !files->empty()) return files;
  }
  return Error{ErrorCode::invalid_argument, "folder '" + folder +
                                                "' has no cloud files (.bin, .pcd, .ply), nor has a "
                                                "velodyne/, velodyne_points/data/ or data/ in it"};
}

Result<Paths> expand_pattern(const std::string& pattern) {
  glob_t matches{};
  const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &matches);
  Paths files;
  for (std::size_t i = 0; i < matches.gl_pathc; ++i) {
    std::error_code no_status;
    if (!fs::is_directory(matches.gl_pathv[i], no_status)) files.emplace_back(matches.gl_pathv[i]);
  }
  ::globfree(&matches);
  if (status == GLOB_NOSPACE) {
    return Error{ErrorCode::resource_limit,
                 "pattern '" + pattern + "' matches too many files for the memory"};
  }
  if (files.empty()) {
    return Error{ErrorCode::invalid_argument, "pattern '" + pattern + "' matches no file"};
  }
  sort_naturally(files);
  return files;
}

Result<Paths> expand(const std::string& argument) {
  std::error_code error;
  const fs::file_status status = fs::status(argument, error);
  if (fs::is_directory(status)) return expand_folder(argument);
  if (fs::exists(status)) return Paths{argument};  // also where its name contains * ? [
  if (argument.find_first_of("*?[") != argument.npos) return expand_pattern(argument);
  return Error{ErrorCode::invalid_argument,
               "there is no file or folder '" + argument + "'" + (error ? ": " + error.message() : "")};
}

Result<Paths> expand_all(std::span<const std::string> arguments) {
  Paths all;
  for (const std::string& argument : arguments) {
    const auto paths = expand(argument);
    if (!paths) return paths.error();
    all.insert(all.end(), paths->begin(), paths->end());
  }
  return all;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    if (is_digit(rest_a[0]) && is_digit(rest_b[0])) {
      const std::string_view number_a = take_number(rest_a), number_b = take_number(rest_b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
      continue;
    }
    if (rest_a[0] != rest_b[0]) {
      return static_cast<unsigned char>(rest_a[0]) < static_cast<unsigned char>(rest_b[0]);
    }
    rest_a.remove_prefix(1);
    rest_b.remove_prefix(1);
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;  // differ only in leading zeros, if at all
}

Result<std::vector<fs::path>> expand_inputs(std::span<const std::string> arguments) {
  try {
    return expand_all(arguments);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::resource_limit, "there is not enough memory for the list of input files"};
  }
}

}  // namespace pointreel
