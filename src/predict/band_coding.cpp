#include "predict/band_coding.h"

#include <algorithm>
#include <string>

// SSE4, AVX2 and NEON carry their weight; AVX-512 is slower here, its wide divisions and square roots are.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#define HWY_TARGET_INCLUDE "predict/band_coding.cpp"
#include "hwy/foreach_target.h"
//
#include "entropy/adaptive_models.h"
#include "predict/hit_mask.h"
#include "predict/range_model-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// False when a decoder runs out of bytes. Both streams advance cell by cell, each predicted from the other.
template <class Coder>
bool code_band(Coder& mask_coder, Coder& range_coder, const RangeQuantiser& quantiser, const Band& band,
               GridImage& image, BandState& state) {
  HitMaskModel mask({band.first_row, band.rows, image.columns, image.rows}, {}, std::move(state.mask));
  RangeModel<> ranges(band, image.columns, quantiser, state.ranges);
  for (int row = 0; row < band.rows; ++row) {
    const int image_row = band.first_row + row;
    mask.begin_row();
    ranges.start_row(
        row, quantiser.on_lattice() ? quantiser.lattice_phase_m[static_cast<std::size_t>(image_row)] : 0);
    float* range_m = &image.range_m[image.index(image_row, 0)];
    for (int column = 0; column < image.columns; ++column) {
      if (!mask.code(mask_coder, range_m[column] > 0)) continue;
      range_m[column] = ranges.code(range_coder, column, range_m[column]);
      mask.set_range(range_m[column]);
    }
    if constexpr (Coder::kDecodes) {
      if (mask_coder.overran() || range_coder.overran()) return false;
    }
  }
  state.mask = mask.state();
  return true;
}

CodedBand encode(const RangeQuantiser& quantiser, const Band& band, GridImage& image, BandState& state) {
  BitEncoder mask_coder, range_coder;
  code_band(mask_coder, range_coder, quantiser, band, image, state);
  return {mask_coder.finish(), range_coder.finish()};
}

bool decode(const RangeQuantiser& quantiser, const Band& band, std::span<const std::uint8_t> mask,
            std::span<const std::uint8_t> ranges, GridImage& image, BandState& state) {
  BitDecoder mask_coder(mask), range_coder(ranges);
  return code_band(mask_coder, range_coder, quantiser, band, image, state);
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pointreel {

HWY_EXPORT(encode);
HWY_EXPORT(decode);

std::vector<Band> bands_of(int rows, int columns) {
  constexpr int kCellsPerBand = 70'000;
  const int wanted =
      static_cast<int>((static_cast<std::int64_t>(rows) * columns + kCellsPerBand / 2) / kCellsPerBand);
  const int count = std::clamp(wanted, 1, std::max(1, rows / 8));
  std::vector<Band> bands;
  for (int i = 0; i < count; ++i) {
    const int first = rows * i / count;
    bands.push_back({first, rows * (i + 1) / count - first});
  }
  return bands;
}

BandState BandState::from_priors(const RangeQuantiser& quantiser, const Band& band) {
  return {HitMaskState::from_priors(band.rows), RangeModelState::from_priors(quantiser.step_m)};
}

CodedBand encode_band(const RangeQuantiser& quantiser, const Band& band, GridImage& image, BandState& state) {
  return HWY_DYNAMIC_DISPATCH(encode)(quantiser, band, image, state);
}

Result<void> decode_band(const RangeQuantiser& quantiser, const Band& band,
                         std::span<const std::uint8_t> mask, std::span<const std::uint8_t> ranges,
                         GridImage& image, BandState& state) {
  if (!HWY_DYNAMIC_DISPATCH(decode)(quantiser, band, mask, ranges, image, state)) {
    return Error{ErrorCode::truncated, "the ranges end before the last of rows " +
                                           std::to_string(band.first_row) + " to " +
                                           std::to_string(band.first_row + band.rows - 1)};
  }
  return {};
}

}  // namespace pointreel
#endif  // HWY_ONCE
