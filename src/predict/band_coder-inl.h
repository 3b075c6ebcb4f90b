// Codes one band of rows along the wavefront: is there a return, and at which range?

#if defined(POINTREEL_PREDICT_BAND_CODER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_BAND_CODER_INL_H_
#undef POINTREEL_PREDICT_BAND_CODER_INL_H_
#else
#define POINTREEL_PREDICT_BAND_CODER_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "predict/band_coding.h"
#include "predict/fast_range_model-inl.h"
#include "predict/hit_mask-inl.h"
#include "predict/known_ranges-inl.h"
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
  HitMaskModel<kEffort, kPredicted> mask(columns, state.mask);
  using Ranges = std::conditional_t<kEffort == Effort::fast, FastRangeModel, RangeModel<kEffort, kPredicted>>;
  Ranges ranges(columns, setting, state);
  // An encoder's ranges, until those that a decoder gets take their place.
  SkewedPlane<float> block_m(columns);
  KnownRanges known(columns, setting.known_range_m);
  ReferencePlanes reference(kPredicted ? columns : 0);
  for (int first = 0; first < band.rows; first += kRows) {
    const int rows = std::min(kRows, band.rows - first);
    std::array<float, kRows> phase_m{};
    for (int row = 0; row < rows && quantiser.on_lattice(); ++row)
      phase_m[static_cast<std::size_t>(row)] =
          quantiser.lattice_phase_m[static_cast<std::size_t>(band.first_row + first + row)];
    const auto image_row = [&](int row) {
      return std::span(image.range_m)
          .subspan(image.index(band.first_row + first + row, 0), static_cast<std::size_t>(columns));
    };
    for (int row = 0; row < rows && !Coder::kDecodes; ++row)
      block_m.set_row(row, std::span<const float>(image_row(row)));
    mask.start_block();
    ranges.start_block(phase_m);
    if (known.any()) known.load_block(band.first_row + first, rows);
    if constexpr (kPredicted) reference.load_block(*setting.reference, band.first_row + first);
    for (int step = 0; step < Wavefront::steps(columns); ++step) {
      mask.start_step();
      ranges.start_step();
      // Row r stands at column step - kLag r.
      const int end_row = std::min(rows, step / kLag + 1);
      const int first_row =
          std::min(end_row, std::max(0, (step - columns) / kLag + (step >= columns ? 1 : 0)));
      const std::uint32_t inside = (1U << end_row) - (1U << first_row);
      const Float8 range_m = load<8>(block_m.at(step));
      std::uint32_t hits = Coder::kDecodes ? 0 : lane_bits(all<8>(0) < range_m) & inside;  // a bit a row
      std::uint32_t remaining = inside;  // to be coded one by one
      const std::uint32_t sure = mask.sure_cells(step, inside, &reference);
      if (sure != 0 && mask.code_together(mask_coder, sure, (hits & sure) == sure)) {
        hits |= sure;
        remaining &= ~sure;
      }
      if (remaining != 0) {
        mask.predict(step, &reference);
        for (; remaining != 0; remaining = without_first_lane(remaining)) {
          const std::size_t row = first_lane(remaining);
          if (mask.code(mask_coder, row, first + static_cast<int>(row), (hits >> row & 1) != 0))
            hits |= 1U << row;
        }
      }
      if (const std::uint32_t cells = known.any() ? hits & known.cells(step) : 0; cells != 0) {
        ranges.take_known(known.at(step), cells);
        hits &= ~cells;
      }
      if (hits != 0) ranges.predict(step, &reference);
      store(ranges.code(range_coder, hits, first, range_m), block_m.at(step));
      ranges.remember(step);
      mask.remember(step, ranges.decoded_m());
      if constexpr (Coder::kDecodes) {
        if (step % 64 == 0 && (mask_coder.overran() || range_coder.overran())) return false;
      }
    }
    for (int row = 0; row < rows; ++row) block_m.get_row(row, image_row(row));
  }
  if constexpr (Coder::kDecodes) return !mask_coder.overran() && !range_coder.overran();
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
