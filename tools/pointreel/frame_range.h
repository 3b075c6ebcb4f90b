// --frames: which sweeps of a reel.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "pointreel/result.h"

namespace pointreel {

struct FrameRange {
  std::uint32_t begin = 0;
  std::uint32_t end = std::numeric_limits<std::uint32_t>::max();  // exclusive
  bool contains(std::uint32_t frame) const { return frame >= begin && frame < end; }
};

// "A:B", "A:", ":B" (B exclusive) or a single "A".
Result<FrameRange> parse_frames(const std::string& text);

}  // namespace pointreel
