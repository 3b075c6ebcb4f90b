// Small text files of numbers, line by line, with errors that begin "file:line: ".
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pointreel/result.h"

namespace pointreel {

struct TextLine {
  const std::filesystem::path& path;
  std::size_t number = 0;  // from 1, as editors count
  std::string_view text;   // without line end and surrounding blanks

  Error error(std::string_view what) const;  // corrupt, "path:number: what"
};

Error file_error(ErrorCode code, const std::filesystem::path& path, std::string_view what);

// Calls `on_line` for every line that is neither empty nor a # comment, and stops at its first error. Errors
// of its own: io_error, corrupt for a line too long to be text, resource_limit for more lines than memory is
// for.
Result<void> for_each_line(const std::filesystem::path& path,
                           const std::function<Result<void>(const TextLine&)>& on_line);

enum class Separator { blanks, comma };

std::string_view trim_blanks(std::string_view text);
std::vector<std::string_view> split(std::string_view text, Separator separator);

// The whole of `text` as a finite number, in any locale.
std::optional<double> parse_number(std::string_view text);

// Every word of `line` as a number; the error names the word that is none.
Result<std::vector<double>> parse_numbers(const TextLine& line, Separator separator);
// The same, where the format wants exactly `count` of them.
Result<std::vector<double>> parse_numbers(const TextLine& line, Separator separator, std::size_t count);

// Shortest text that reads back as the same double.
void append_number(std::string& text, double value);
Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace pointreel
