// Which frames of a stream did not come through.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pointreel {

class MissingFrames {
 public:
  // Frames before `first` are not expected.
  explicit MissingFrames(std::uint32_t first) : first_(first) {}

  void decoded(std::uint32_t frame) { decoded_.insert(frame); }

  // First and last frame of each gap before the last frame that was decoded.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> gaps() const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> gaps;
    std::uint32_t next = first_;
    for (const std::uint32_t frame : decoded_) {
      if (frame > next) gaps.emplace_back(next, frame - 1);
      next = frame + 1;
    }
    return gaps;
  }

 private:
  std::uint32_t first_;
  std::set<std::uint32_t> decoded_;
};

// "3, 5 to 7"
inline std::string describe_gaps(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& gaps) {
  std::string text;
  for (const auto& [first, last] : gaps) {
    text += (text.empty() ? "" : ", ") + std::to_string(first);
    if (last != first) text += " to " + std::to_string(last);
  }
  return text;
}

}  // namespace pointreel
