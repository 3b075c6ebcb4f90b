// From ranges to whole steps of the quantiser.

#if defined(POINTREEL_PREDICT_RANGE_ROUNDING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_RANGE_ROUNDING_INL_H_
#undef POINTREEL_PREDICT_RANGE_ROUNDING_INL_H_
#else
#define POINTREEL_PREDICT_RANGE_ROUNDING_INL_H_
#endif

#include <cmath>
#include <cstdint>

#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Hostile streams reach beyond the integers, where processors disagree about conversions.
POINTREEL_INLINE std::int32_t rounded(float x) {
  constexpr float kMost = 1 << 30;
  x = x < kMost ? x : kMost;
  x = x > -kMost ? x : -kMost;
  return static_cast<std::int32_t>(x + std::copysign(0.5F, x));  // a branch would be mispredicted
}

POINTREEL_INLINE Int8 rounded(const Float8& x) {
  constexpr float kMost = 1 << 30;
  const Float8 limited = larger(smaller(x, all<8>(kMost)), all<8>(-kMost));
  return truncated(limited + with_sign_of(limited, all<8>(0.5F)));
}

// The nearest of a row's multiples of `step_m` plus `phase_m`.
POINTREEL_INLINE float nearest_on_lattice(float range_m, float step_m, float phase_m) {
  return static_cast<float>(rounded((range_m - phase_m) / step_m)) * step_m + phase_m;
}

POINTREEL_INLINE Float8 nearest_on_lattice(const Float8& range_m, float step_m, const Float8& phase_m) {
  return step_m * as_floats(rounded((range_m - phase_m) / all<8>(step_m))) + phase_m;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
