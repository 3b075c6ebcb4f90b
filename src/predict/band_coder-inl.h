// Codes one band of rows along the wavefront: is there a return, and at which range?

#if defined(POINTREEL_PREDICT_BAND_CODER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_BAND_CODER_INL_H_
#undef POINTREEL_PREDICT_BAND_CODER_INL_H_
#else
#define POINTREEL_PREDICT_BAND_CODER_INL_H_
#endif

#include <algorithm>

#include "predict/band_coding.h"
#include "predict/hit_mask-inl.h"
#include "predict/range_model-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// False when a decoder runs out of bytes. Two streams, each predicted from what both hold before the cell.
template <Effort kEffort, bool kPredicted, class Coder>
bool code_band(Coder& mask_coder, Coder& range_coder, const BandSetting& setting, const Band& band,
               GridImage& image, BandState& state) {
  constexpr int kRows = Wavefront::kRows, kLag = Wavefront::kLag;
  const RangeQuantiser& quantiser = setting.quantiser;
  const int columns = image.columns;
  const float* known_m = setting.known_range_m.empty() ? nullptr : setting.known_range_m.data();
  HitMaskModel<kEffort, kPredicted> mask(columns, state.mask);
  RangeModel<kEffort, kPredicted> ranges(columns, setting, state.ranges);
  ReferencePlanes reference(kPredicted ? columns : 0);
  for (int first = 0; first < band.rows; first += kRows) {
    const int rows = std::min(kRows, band.rows - first);
    std::array<float, kRows> phase_m{};
    for (int row = 0; row < rows && quantiser.on_lattice(); ++row)
      phase_m[static_cast<std::size_t>(row)] =
          quantiser.lattice_phase_m[static_cast<std::size_t>(band.first_row + first + row)];
    mask.start_block(first == 0);
    ranges.start_block(first == 0, phase_m);
    if constexpr (kPredicted) reference.load_block(*setting.reference, band.first_row + first);
    for (int step = 0; step < Wavefront::steps(columns); ++step) {
      mask.predict(step, &reference);
      ranges.start_step();
      // Row r stands at column step - kLag r.
      const int first_row = std::max(0, (step - columns) / kLag + (step >= columns ? 1 : 0));
      const int end_row = std::min(rows, step / kLag + 1);
      for (int row = first_row; row < end_row; ++row) {
        const auto cell = static_cast<std::size_t>(row);
        const std::size_t index = image.index(band.first_row + first + row, step - kLag * row);
        float& range_m = image.range_m[index];
        if (!mask.code(mask_coder, cell, first + row, range_m > 0)) continue;
        if (known_m != nullptr && known_m[index] > 0) {
          range_m = ranges.take_known(cell, known_m[index]);
        } else {
          if (!ranges.has_predicted()) ranges.predict(step, &reference);
          range_m = ranges.code(range_coder, cell, first + row, range_m);
        }
      }
      ranges.remember(step);
      mask.remember(step, ranges.decoded_m());
      if constexpr (Coder::kDecodes) {
        if (step % 64 == 0 && (mask_coder.overran() || range_coder.overran())) return false;
      }
    }
  }
  if constexpr (Coder::kDecodes) return !mask_coder.overran() && !range_coder.overran();
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
