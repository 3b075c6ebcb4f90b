// Bands: the rows of an image that are coded together, without a look at the others, so that a sweep can be
// coded by several threads. They are a property of the stream, not of the machine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/result.h"
#include "predict/grid_image.h"
#include "predict/range_quantiser.h"

namespace pointreel {

struct Band {
  int first_row = 0;
  int rows = 0;
};

// About 70,000 cells each: fewer learn too little, more leave threads idle.
std::vector<Band> bands_of(int rows, int columns);

struct CodedBand {
  std::vector<std::uint8_t> mask;    // which cells hold a return
  std::vector<std::uint8_t> ranges;  // of those that do
};

// Ranges in the band must be 0 or positive and within kMostRangeSteps steps; they are replaced by what the
// decoder will see, within half a step of the original but for float rounding.
CodedBand encode_band(const RangeQuantiser& quantiser, const Band& band, GridImage& image);

// Fills the band's rows of `image`. Error: truncated, when there are fewer bytes than the cells need.
Result<void> decode_band(const RangeQuantiser& quantiser, const Band& band, std::span<const std::uint8_t> mask,
                         std::span<const std::uint8_t> ranges, GridImage& image);

inline constexpr float kMostRangeSteps = 1 << 24;

}  // namespace pointreel
