// Lines in inverse range that follow each row, and its mean step from the row above; eight rows at once.

#if defined(POINTREEL_PREDICT_ROW_LINES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_ROW_LINES_INL_H_
#undef POINTREEL_PREDICT_ROW_LINES_INL_H_
#else
#define POINTREEL_PREDICT_ROW_LINES_INL_H_
#endif

#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// By how much of an error a line's level and slope follow it.
struct LineRates {
  float level, slope;
};
inline constexpr LineRates kSmoothLineRates = {0.35F, 0.1F};  // beside other extrapolations

// No sums over neighbours, as fits need them.
class RowLines {
 public:
  POINTREEL_INLINE explicit RowLines(const LineRates& rates)
      : rates_(rates), level_(all<8>(0)), slope_(level_), grown_(level_), step_(level_), weight_(level_) {}

  // The row's line at its next return: Holt's double exponential smoothing.
  POINTREEL_INLINE Float8 line() const { return level_ + slope_; }
  // The inverse range above, plus the mean step from the row above to this one; 0 where none is known.
  POINTREEL_INLINE Float8 parallel(const Float8& inverse_above) const {
    const Mask<8> known = (all<8>(kLeastWeight) <= weight_) & (all<8>(0) < inverse_above);
    return where(known, inverse_above + step_ / larger(weight_, all<8>(kLeastWeight)));
  }

  // The next cells. `last_m`: the row's return before them; `inverse`: 0 where there is no return.
  POINTREEL_INLINE void add(const Float8& range_m, const Float8& inverse, const Float8& last_m,
                            const Float8& inverse_above) {
    const Mask<8> hit = all<8>(0) < inverse;
    const Mask<8> goes_on = absolute(range_m - last_m) <= 0.03F * last_m + all<8>(0.3F);
    const Float8 line = this->line();
    const Float8 error = inverse - line;
    // The second point of a line gives its slope whole.
    const Mask<8> young = grown_ <= all<8>(0);
    const Float8 level = line + select(young, all<8>(1), all<8>(rates_.level)) * error;
    const Float8 slope = slope_ + select(young, all<8>(1), all<8>(rates_.slope)) * error;
    level_ = select(hit, select(goes_on, level, inverse), level_);
    slope_ = select(hit, where(goes_on, slope), slope_);
    grown_ = select(hit, where(goes_on, all<8>(1)), grown_);
    const Float8 kept = where(goes_on, all<8>(kStepsKept));
    const Mask<8> both = all<8>(0) < inverse_above;
    step_ = select(hit, where(both, kept * step_ + (inverse - inverse_above)), step_);
    weight_ = select(hit, where(both, kept * weight_ + all<8>(1)), weight_);
  }

 private:
  static constexpr float kStepsKept = 0.8F, kLeastWeight = 0.5F;

  LineRates rates_;
  Float8 level_, slope_, grown_;
  Float8 step_, weight_;  // of the steps from the row above, summed
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
