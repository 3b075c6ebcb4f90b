// The coded cells around those of one step of the wavefront, eight at once.

#if defined(POINTREEL_PREDICT_NEIGHBOURHOOD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_NEIGHBOURHOOD_INL_H_
#undef POINTREEL_PREDICT_NEIGHBOURHOOD_INL_H_
#else
#define POINTREEL_PREDICT_NEIGHBOURHOOD_INL_H_
#endif

#include "base/lanes-inl.h"
#include "predict/wavefront.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr float kSmallestRangeM = 1e-3F;  // of a return

POINTREEL_INLINE Mask<8> seen(const Float8& range_m) {
  return all<8>(kSmallestRangeM) <= range_m;
}
// Both seen, and no farther apart.
POINTREEL_INLINE Mask<8> same_surface(const Float8& range_m, const Float8& other_m, float most_m) {
  return (absolute(range_m - other_m) <= all<8>(most_m)) & seen(range_m) & seen(other_m);
}

// Ranges as far as they are coded; 0 where there is no return.
struct RangePlanes {
  SkewedPlane<float> range_m, inverse_range;

  explicit RangePlanes(int columns) : range_m(columns), inverse_range(columns) {}
  void keep_for_next_block(int step) {
    range_m.keep_for_next_block(step);
    inverse_range.keep_for_next_block(step);
  }
};

class Neighbourhood {
 public:
  POINTREEL_INLINE Neighbourhood(const RangePlanes& planes, int step) : planes_(planes), step_(step) {}

  // Columns to the right of the cell, rows below it: only cells before it are there.
  POINTREEL_INLINE Float8 range_m(int columns_right, int rows_down = 0) const {
    return load<8>(planes_.range_m.at(step_, columns_right, rows_down));
  }
  POINTREEL_INLINE Float8 inverse_range(int columns_right, int rows_down = 0) const {
    return load<8>(planes_.inverse_range.at(step_, columns_right, rows_down));
  }

 private:
  const RangePlanes& planes_;
  int step_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
