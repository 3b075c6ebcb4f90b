#include "pointreel/frame_range.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

namespace pointreel {

Result<FrameRange> parse_frames(const std::string& text) {
  FrameRange range;
  const auto number = [&](std::string_view part, std::uint32_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  const std::size_t colon = text.find(':');
  const std::string_view first = std::string_view(text).substr(0, colon);
  bool good = true;
  if (colon == std::string::npos) {
    good = number(first, range.begin);
    range.end = range.begin + 1;
  } else {
    const std::string_view second = std::string_view(text).substr(colon + 1);
    if (!first.empty()) good = number(first, range.begin);
    if (!second.empty()) good = good && number(second, range.end);
  }
  if (!good || range.begin >= range.end) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("--frames: '{}' is not A:B with A < B (B is not included)", text)};
  }
  return range;
}

}  // namespace pointreel
