// How far the ranges of each row lie from those of the warped reference, lately; eight rows at once.

#if defined(POINTREEL_PREDICT_REFERENCE_BIAS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_REFERENCE_BIAS_INL_H_
#undef POINTREEL_PREDICT_REFERENCE_BIAS_INL_H_
#else
#define POINTREEL_PREDICT_REFERENCE_BIAS_INL_H_
#endif

#include "predict/neighbourhood-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// What the motion leaves, and what the lasers differ by: a point is predicted from those of other lasers. It
// changes along a row, and from one row to the next (docs/MIXTURE.md).
class ReferenceBias {
 public:
  // The coarser the steps of the ranges, the less each says.
  POINTREEL_INLINE explicit ReferenceBias(float step_m)
      : mean_m_(all<8>(0)), rate_(kRate / (1 + kPerSquaredStep * (step_m * step_m))) {}

  // `range_m`: of the reference; 0, nothing is known, stays.
  POINTREEL_INLINE Float8 corrected(const Float8& range_m) const {
    return where(seen(range_m), range_m + mean_m_);
  }

  // The next cells; range 0: no return.
  POINTREEL_INLINE void add(const Float8& range_m, const Float8& reference_m) {
    const Mask<8> same = same_surface(range_m, reference_m, kSameSurfaceM);
    mean_m_ = mean_m_ + where(same, rate_ * (range_m - reference_m - mean_m_));
  }

 private:
  static constexpr float kRate = 1.F / 16, kPerSquaredStep = 64, kSameSurfaceM = 0.3F;

  Float8 mean_m_;
  float rate_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
