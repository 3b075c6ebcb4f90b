// Error messages that say where in which file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "pointreel/result.h"

namespace pointreel::io {

inline Error error_at_line(ErrorCode code, const std::string& file, std::size_t line, std::string_view what) {
  return {code, file + ", line " + std::to_string(line) + ": " + std::string(what)};
}

inline Error error_at_byte(ErrorCode code, const std::string& file, std::size_t offset,
                           std::string_view what) {
  return {code, file + ", byte offset " + std::to_string(offset) + ": " + std::string(what)};
}

// Text from a file for a message: damaged files must not fill or garble the user's terminal.
inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t max_length = 40;
  std::string result = "'";
  for (const char c : text.substr(0, max_length)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > max_length ? "...'" : "'");
}

}  // namespace pointreel::io
