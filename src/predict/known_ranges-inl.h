// Ranges that returns have without being coded, since both sides know them: those on planes.

#if defined(POINTREEL_PREDICT_KNOWN_RANGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_KNOWN_RANGES_INL_H_
#undef POINTREEL_PREDICT_KNOWN_RANGES_INL_H_
#else
#define POINTREEL_PREDICT_KNOWN_RANGES_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/lanes-inl.h"
#include "predict/wavefront.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

class KnownRanges {
 public:
  // `range_m`: by cell of the image, 0: not known; or empty.
  KnownRanges(int columns, std::span<const float> range_m)
      : columns_(static_cast<std::size_t>(columns)), range_m_(range_m), block_m_(any() ? columns : 0) {}

  bool any() const { return !range_m_.empty(); }

  HWY_NOINLINE void load_block(int first_row, int rows) {
    for (int row = 0; row < rows; ++row)
      block_m_.set_row(row, range_m_.subspan(static_cast<std::size_t>(first_row + row) * columns_, columns_));
  }

  // Of the eight cells of a step.
  POINTREEL_INLINE Float8 at(int step) const { return load<8>(block_m_.at(step)); }
  // Those that are known, a bit each.
  POINTREEL_INLINE std::uint32_t cells(int step) const { return lane_bits(all<8>(0) < at(step)); }

 private:
  std::size_t columns_;
  std::span<const float> range_m_;
  SkewedPlane<float> block_m_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
