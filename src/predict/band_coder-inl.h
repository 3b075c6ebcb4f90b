// Codes one band of rows along the wavefront: is there a return, and at which range?

#if defined(POINTREEL_PREDICT_BAND_CODER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_BAND_CODER_INL_H_
#undef POINTREEL_PREDICT_BAND_CODER_INL_H_
#else
#define POINTREEL_PREDICT_BAND_CODER_INL_H_
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "predict/band_coding.h"
#include "predict/fast_range_model-inl.h"
#include "predict/hit_mask-inl.h"
#include "predict/known_ranges-inl.h"
#include "predict/range_model-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// The first of rows, a bit each, and the others.
POINTREEL_INLINE int first_of(std::uint32_t rows) {
  return std::countr_zero(rows);
}
POINTREEL_INLINE std::uint32_t without_first(std::uint32_t rows) {
  return rows & (rows - 1);
}

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
  KnownRanges known(columns, setting.known_range_m);
  ReferencePlanes reference(kPredicted ? columns : 0);
  for (int first = 0; first < band.rows; first += kRows) {
    const int rows = std::min(kRows, band.rows - first);
    std::array<float, kRows> phase_m{};
    for (int row = 0; row < rows && quantiser.on_lattice(); ++row)
      phase_m[static_cast<std::size_t>(row)] =
          quantiser.lattice_phase_m[static_cast<std::size_t>(band.first_row + first + row)];
    // Row r stands at column step - kLag r.
    std::array<std::ptrdiff_t, kRows> row_start{};
    for (int row = 0; row < rows; ++row) {
      row_start[static_cast<std::size_t>(row)] =
          static_cast<std::ptrdiff_t>(image.index(band.first_row + first + row, 0)) -
          std::ptrdiff_t{kLag} * row;
    }
    mask.start_block();
    ranges.start_block(phase_m);
    if (known.any()) known.load_block(band.first_row + first, rows);
    if constexpr (kPredicted) reference.load_block(*setting.reference, band.first_row + first);
    for (int step = 0; step < Wavefront::steps(columns); ++step) {
      mask.start_step();
      ranges.start_step();
      const int first_row = std::max(0, (step - columns) / kLag + (step >= columns ? 1 : 0));
      const int end_row = std::min(rows, step / kLag + 1);
      const auto range_of = [&](int row) HWY_ATTR -> float& {
        return image.range_m[static_cast<std::size_t>(row_start[static_cast<std::size_t>(row)] + step)];
      };
      const auto are_hits = [&]() HWY_ATTR {
        bool all = true;
        for (int row = 0; row < kRows; ++row) all = all & (range_of(row) > 0);
        return all;
      };
      std::uint32_t hits = 0;  // a bit a row
      if (kEffort != Effort::max && end_row - first_row == kRows && mask.are_sure(step, &reference) &&
          mask.code_together(mask_coder, !Coder::kDecodes && are_hits())) {
        hits = (1U << kRows) - 1;
      } else {
        mask.predict(step, &reference);
        for (int row = first_row; row < end_row; ++row) {
          if (mask.code(mask_coder, static_cast<std::size_t>(row), first + row, range_of(row) > 0))
            hits |= 1U << row;
        }
      }
      if (const std::uint32_t cells = known.any() ? hits & known.cells(step) : 0; cells != 0) {
        ranges.take_known(known.at(step), cells);
        for (std::uint32_t left = cells; left != 0; left = without_first(left))
          range_of(first_of(left)) = known.at(step, first_of(left));
        hits &= ~cells;
      }
      if (hits != 0) ranges.predict(step, &reference);
      for (std::uint32_t left = hits; left != 0; left = without_first(left))
        ranges.start(static_cast<std::size_t>(first_of(left)), first + first_of(left));
      for (std::uint32_t left = hits; left != 0; left = without_first(left)) {
        const int row = first_of(left);
        float& range_m = range_of(row);
        range_m = ranges.code(range_coder, static_cast<std::size_t>(row), first + row, range_m);
      }
      for (std::uint32_t left = hits; left != 0; left = without_first(left))
        ranges.learn(static_cast<std::size_t>(first_of(left)));
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
