// Codes the bands of an image (bands.h): which cells hold a return, and at which range.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/result.h"
#include "predict/bands.h"
#include "predict/coding_kind.h"
#include "predict/fast_range_state.h"
#include "predict/grid_image.h"
#include "predict/hit_mask_state.h"
#include "predict/max_range_state.h"
#include "predict/range_config.h"
#include "predict/range_quantiser.h"
#include "predict/range_state.h"
#include "predict/reference_image.h"

namespace pointreel {

// Everything that adapts while a band is coded.
struct BandState {
  HitMaskState mask;
  RangeModelState ranges;
  MaxRangeState trust;  // in its place where has_trust()
  FastRangeState fast;  // in its place at effort fast
};

struct CodedBand {
  std::vector<std::uint8_t> mask;    // which cells hold a return
  std::vector<std::uint8_t> ranges;  // of those that do
};

// What both sides know before the first cell.
struct BandSetting {
  CodingKind kind;
  const RangeQuantiser& quantiser;
  const ReferenceImage* reference = nullptr;  // of the image's size; for predicted frames only
  Ingredients ingredients = {};
  // By cell of the image, or empty: ranges that returns have without being coded; 0: not known.
  std::span<const float> known_range_m = {};
};

// Ranges in the band must be 0 or positive and within kMostRangeSteps steps; they are replaced by what the
// decoder will see, within half a step of the original but for float rounding.
CodedBand encode_band(const BandSetting& setting, const Band& band, GridImage& image, BandState& state);

// Fills the band's rows of `image`. Error: truncated, when there are fewer bytes than the cells need.
Result<void> decode_band(const BandSetting& setting, const Band& band, std::span<const std::uint8_t> mask,
                         std::span<const std::uint8_t> ranges, GridImage& image, BandState& state);

}  // namespace pointreel
