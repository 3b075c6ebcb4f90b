// The arctangent of base/trigonometry.h, eight at once.

#if defined(POINTREEL_BASE_ARC_TANGENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_BASE_ARC_TANGENT_INL_H_
#undef POINTREEL_BASE_ARC_TANGENT_INL_H_
#else
#define POINTREEL_BASE_ARC_TANGENT_INL_H_
#endif

#include "base/lanes-inl.h"
#include "base/trigonometry.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// fast_atan2, to the same bits.
POINTREEL_INLINE Float8 arc_tangent(const Float8& y, const Float8& x) {
  const Float8 ax = absolute(x), ay = absolute(y);
  const Mask<8> steep = ax < ay;
  const Float8 t = select(steep, ax, ay) / larger(select(steep, ay, ax), all<8>(1e-37F));
  const Float8 t2 = t * t;
  Float8 ratio = all<8>(kArcTangentCoefficients[9]);
  for (int i = 8; i >= 0; --i) ratio = ratio * t2 + all<8>(kArcTangentCoefficients[i]);
  constexpr auto kHalfTurn = static_cast<float>(kPi);
  Float8 angle = ratio * t;
  angle = select(steep, all<8>(kHalfTurn / 2) - angle, angle);
  angle = select(x < all<8>(0), all<8>(kHalfTurn) - angle, angle);
  return select(y < all<8>(0), all<8>(0) - angle, angle);
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
