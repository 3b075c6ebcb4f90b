// How wrong each expert was lately along each of eight rows: what is right on a kerb stays so.

#if defined(POINTREEL_PREDICT_RECENT_ERRORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_RECENT_ERRORS_INL_H_
#undef POINTREEL_PREDICT_RECENT_ERRORS_INL_H_
#else
#define POINTREEL_PREDICT_RECENT_ERRORS_INL_H_
#endif

#include <cstddef>

#include "predict/experts-inl.h"
#include "predict/neighbourhood-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Squared errors at the row's last return, and their running mean. Both are clipped: depth edges, where all
// are wrong, say little. What was right in the row above is a worse guide, and costs a plane of errors for
// each expert.
template <std::size_t kExperts>
class RecentErrors {
 public:
  POINTREEL_INLINE RecentErrors() {}
  POINTREEL_INLINE explicit RecentErrors(float step_m) : squared_step_m2_(step_m * step_m) {
    for (std::size_t k = 0; k < kExperts; ++k) {
      last_m2_[k] = all<8>(kUnknownSquaredSteps * squared_step_m2_);
      mean_m2_[k] = all<8>(squared_step_m2_);
    }
  }

  // More where the cell to the left is empty: who knows what the row shows beyond the gap.
  POINTREEL_INLINE Float8 beyond_gap_m2(const Neighbourhood& cells) const {
    return select(seen(cells.range_m(-1)), all<8>(0), all<8>(kUnknownSquaredSteps * squared_step_m2_));
  }
  POINTREEL_INLINE Float8 mean_square_m2(std::size_t expert) const {
    return last_m2_[expert] + kMeanShare * mean_m2_[expert];
  }

  // The next cells; range 0: no return. `proposed`: whether experts were asked; where not, the surface counts
  // as smooth.
  HWY_NOINLINE void add(const Proposals<kExperts>& proposals, const Float8& decoded_m, bool proposed) {
    const Mask<8> hit = seen(decoded_m);
    if (!proposed) {
      const Float8 smooth_m2 = all<8>(kSmoothSquaredSteps * squared_step_m2_);
      for (Float8& last_m2 : last_m2_) last_m2 = select(hit, smooth_m2, last_m2);
      return;
    }
    const Float8 most_of_mean_m2 = all<8>(kMostSquaredSteps * squared_step_m2_);
    for (std::size_t k = 0; k < kExperts; ++k) {
      const Float8 error_m = proposals.range_m[k] - decoded_m;
      const Float8 square_m2 = error_m * error_m;
      last_m2_[k] = select(hit, smaller(square_m2, all<8>(kMostSquareM2)), last_m2_[k]);
      mean_m2_[k] = mean_m2_[k] + where(hit, kMeanRate * (smaller(square_m2, most_of_mean_m2) - mean_m2_[k]));
    }
  }

 private:
  static constexpr float kMostSquareM2 = 1;  // an edge, whatever its depth
  static constexpr float kMeanShare = 2, kMeanRate = 1.F / 8, kMostSquaredSteps = 3;
  static constexpr float kUnknownSquaredSteps = 30, kSmoothSquaredSteps = 0.1F;

  float squared_step_m2_;
  Float8 last_m2_[kExperts], mean_m2_[kExperts];
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
