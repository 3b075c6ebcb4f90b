// The mixture: the experts' proposals as one probability distribution of a cell's range.
//
//   P(range < x) = sum_k w_k F((x - c_k) / s_k),   F(z) = (1 + G(z)) / 2,   G(z) = z (1 + |z|) / (1 + |z| +
//   z^2)
//
// F is smooth at 0 and has the tails of Student's t distribution with two degrees of freedom, for a single
// division (that distribution itself and the logistic function give the same rate, for more work). Weight and
// scale of an expert depend on its class, the size of its errors at the neighbouring cells, and follow the
// gradient of the log-likelihood of what is coded.

#if defined(POINTREEL_PREDICT_MIXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_MIXTURE_INL_H_
#undef POINTREEL_PREDICT_MIXTURE_INL_H_
#else
#define POINTREEL_PREDICT_MIXTURE_INL_H_
#endif

#include <bit>

#include "predict/error_history.h"
#include "predict/float16-inl.h"
#include "predict/range_state.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

static_assert(kExperts == 16);

inline constexpr float kLargestSquaredErrorM2 = 4;  // an edge, whatever its depth

// Squared errors of proposals, for the history.
HWY_INLINE void store_errors(const Float16& proposals_m, float range_m, float* errors) {
  const Float16 error_m = proposals_m - all<16>(range_m);
  store(smaller(error_m * error_m, all<16>(kLargestSquaredErrorM2)), errors);
}

// Weighted mean of the squared errors at the coded neighbours of a cell, or `otherwise` if there are none.
HWY_INLINE Float16 recent_errors(const ErrorHistory& history, const CausalCanvas& canvas, std::size_t index,
                                 int column, float otherwise) {
  const float* here = canvas.range_m(index);
  const float* above = here - canvas.stride();
  const float* above2 = above - canvas.stride();
  const float left = here[-1] > 0 ? 2.F : 0.F;
  const float left2 = here[-2] > 0 ? 0.7F : 0.F;
  const float up = above[0] > 0 ? 1.F : 0.F;
  const float up_left = above[-1] > 0 ? 1.F : 0.F;
  const float up_right = above[1] > 0 ? 1.F : 0.F;
  const float up2 = above2[0] > 0 ? 0.7F : 0.F;
  const float total = ((left + left2) + (up + up2)) + (up_left + up_right);
  if (!(total > 0)) return all<16>(otherwise);
  const float* row0 = history.at(0, column);
  const float* row1 = history.at(1, column);
  const auto at = [](const float* row, std::ptrdiff_t columns)
                      HWY_ATTR { return load<16>(row + columns * static_cast<std::ptrdiff_t>(kExperts)); };
  const Float16 in_row = at(row0, -1) * all<16>(left) + at(row0, -2) * all<16>(left2);
  const Float16 in_column = at(row1, 0) * all<16>(up) + load<16>(history.at(2, column)) * all<16>(up2);
  const Float16 across = at(row1, -1) * all<16>(up_left) + at(row1, 1) * all<16>(up_right);
  return ((in_row + in_column) + across) * all<16>(1 / total);
}

// The distribution of one cell.
class Mixture {
 public:
  // The probability below a border between two bins: G of each expert and of the mixture.
  struct Border {
    Float16 signed_cdf;
    Float16 slope;  // z G'(z)
    float mixed;

    HWY_INLINE Border() {}
  };

  // Takes the lane of the blend: the mean of the other proposals, weighted by the inverse fourth power of
  // their recent errors.
  HWY_INLINE Mixture(const MixtureState& state, const Float16& proposals_m, const Float16& mean_squares,
                     float step_m) {
    const float squared_step = step_m * step_m;
    const float floor = squared_step * 0.08F + 1e-5F;
    const Float16 precision = all<16>(1) / (mean_squares + all<16>(floor));
    const Float16 blend_weights = without_first(precision * precision);
    blend_m_ = sum(blend_weights * proposals_m) / sum(blend_weights);
    proposals_m_ = with_lane<0>(proposals_m, blend_m_);

    blend_class_ = error_class(first(mean_squares) / squared_step);
    const MixtureState::PerClass& per_class = state.classes[blend_class_];
    weight_ = load<16>(per_class.weight.data());
    learnt_inverse_scale_ = load<16>(per_class.inverse_scale.data());
    inverse_scale_ = (1 / step_m) * (learnt_inverse_scale_ * square_root(floor * precision));
    per_total_weight_ = 1 / sum(weight_);
  }

  float blend_m() const { return blend_m_; }
  const Float16& proposals_m() const { return proposals_m_; }
  std::size_t blend_class() const { return blend_class_; }

  HWY_INLINE void evaluate(float x_m, Border& border) const {
    const Float16 z = (all<16>(x_m) - proposals_m_) * inverse_scale_;
    const Float16 one = all<16>(1);
    const Float16 size = absolute(z);
    const Float16 tail = one / (one + size * (one + size));  // 1 - |G|
    const Float16 ratio = z * tail;
    border.signed_cdf = ratio + ratio * size;
    border.slope = ratio * tail * (one + size + size);
    border.mixed = sum(weight_ * border.signed_cdf) * per_total_weight_;
  }

  // Moves weights and scales towards what would have made the coded bin more likely. With p_k its
  // probability by expert k and G+, G- at its borders:
  //   d log p / d log w_k = r_k - w_k,  r_k = w_k p_k / p
  //   d log p / d log (1/s_k) = r_k (z+ G'(z+) - z- G'(z-)) / p_k
  template <class Ingredients>
  HWY_INLINE void learn(const Border& lower, const Border& upper, MixtureState& state) const {
    constexpr float kWeightRate = Ingredients::kLearnsWeights ? 0.1F : 0.F;
    constexpr float kScaleRate = Ingredients::kLearnsScales ? 0.08F : 0.F;
    const Float16 one = all<16>(1);
    const Float16& below = lower.signed_cdf;
    const Float16& above = upper.signed_cdf;
    const Float16 p = larger(above - below, all<16>(1e-9F));
    const Float16 slope = upper.slope - lower.slope;
    const Float16 steepness = larger(smaller(slope / p, one), all<16>(-4));
    const Float16 joint = weight_ * p;
    const Float16 responsibility = joint * all<16>(1 / sum(joint));
    MixtureState::PerClass& per_class = state.classes[blend_class_];
    store(
        clamped(weight_ * (one + kWeightRate * (responsibility - per_total_weight_ * weight_)), 1e-4F, 1e4F),
        per_class.weight.data());
    store(clamped(learnt_inverse_scale_ * (one + kScaleRate * responsibility * steepness), 1e-4F, 1e3F),
          per_class.inverse_scale.data());
  }

 private:
  // Half octaves, from a mean squared error in squared steps.
  static std::size_t error_class(float squared_steps) {
    constexpr float kFloor = 0.0016F;  // below it errors are the quantiser's
    constexpr auto kLast = static_cast<std::int32_t>(kErrorClasses) - 1;
    const std::int32_t octave = (std::bit_cast<std::int32_t>(squared_steps + kFloor) >> 23) - 127;
    const std::int32_t from_first = octave - kFirstClassLog2;
    return static_cast<std::size_t>(from_first < kLast ? from_first : kLast);
  }
  static HWY_INLINE Float16 clamped(const Float16& x, float least, float most) {
    return larger(smaller(x, all<16>(most)), all<16>(least));
  }

  Float16 proposals_m_;
  float blend_m_;
  Float16 weight_;                // their sum is 1 / per_total_weight_
  Float16 learnt_inverse_scale_;  // relative to the expert's recent error
  Float16 inverse_scale_;         // per metre
  float per_total_weight_;
  std::size_t blend_class_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
