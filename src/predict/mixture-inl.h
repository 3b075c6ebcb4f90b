// The mixture: the experts' proposals as one probability distribution of a cell's range.
//
//   P(range < x) = sum_k w_k F((x - c_k) / s_k),   F(z) = (1 + G(z)) / 2,
//   G(z) = z (1 + |z|) / (1 + |z| + z^2)
//
// F is smooth at 0 and has the tails of Student's t distribution with two degrees of freedom, for a single
// division (that distribution itself and the logistic function give the same rate, for more work). Weight and
// scale of an expert depend on its class, the size of its errors at the neighbouring cells, and follow the
// gradient of the log-likelihood of what is coded. All cells of a step of the wavefront see them as they were
// before it: so the cells' distributions do not wait for each other.

#if defined(POINTREEL_PREDICT_MIXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_MIXTURE_INL_H_
#undef POINTREEL_PREDICT_MIXTURE_INL_H_
#else
#define POINTREEL_PREDICT_MIXTURE_INL_H_
#endif

#include "predict/blend-inl.h"
#include "predict/range_config.h"
#include "predict/range_state.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// The distribution of one cell, an expert a lane.
template <std::size_t kExperts>
class Mixture {
 public:
  using Lanes = Floats<kExperts>;

  // The probability below a border between two bins: G of each expert and of the mixture.
  struct Border {
    Lanes signed_cdf;
    Lanes slope;  // z G'(z)
    float mixed;

    POINTREEL_INLINE Border() {}
  };

  POINTREEL_INLINE Mixture() {}
  POINTREEL_INLINE Mixture(const MixtureState& state, const BlendedProposals<kExperts>& blended,
                           std::size_t cell)
      : Mixture(state, static_cast<std::size_t>(blended.error_class[cell]), blended, cell) {}

  POINTREEL_INLINE void evaluate(float x_m, Border& border) const {
    const Lanes z = (all<kExperts>(x_m) - proposals_m_) * inverse_scale_;
    const Lanes one = all<kExperts>(1);
    const Lanes size = absolute(z);
    const Lanes tail = one / (one + size * (one + size));  // 1 - |G|
    const Lanes ratio = z * tail;
    border.signed_cdf = ratio + ratio * size;
    border.slope = ratio * tail * (one + size + size);
    border.mixed = sum(weight_ * border.signed_cdf) * per_total_weight_;
  }

  // Moves weights and scales of the cell's class towards what would have made the coded bin more likely; by
  // the gradient at those that the cell saw, so that cells of one class do not wait for each other. With p_k
  // its probability by expert k and G+, G- at its borders:
  //   d log p / d log w_k = r_k - w_k,  r_k = w_k p_k / p
  //   d log p / d log (1/s_k) = r_k (z+ G'(z+) - z- G'(z-)) / p_k
  POINTREEL_INLINE void learn(const Border& lower, const Border& upper, const Ingredients& ingredients,
                              MixtureState& state) const {
    MixtureState::PerClass& per_class = state.classes[error_class_];
    const Lanes one = all<kExperts>(1);
    const Lanes p = larger(upper.signed_cdf - lower.signed_cdf, all<kExperts>(1e-9F));
    const Lanes slope = upper.slope - lower.slope;
    const Lanes steepness = larger(smaller(slope / p, one), all<kExperts>(-4));
    const Lanes joint = weight_ * p;
    const Lanes responsibility = joint * all<kExperts>(1 / sum(joint));
    const Lanes weight_factor =
        one + ingredients.weight_rate * (responsibility - per_total_weight_ * weight_);
    const Lanes scale_factor = one + ingredients.scale_rate * responsibility * steepness;
    store(clamped(load<kExperts>(per_class.weight.data()) * weight_factor, 1e-4F, 1e4F),
          per_class.weight.data());
    store(clamped(load<kExperts>(per_class.inverse_scale.data()) * scale_factor, 1e-4F, 1e3F),
          per_class.inverse_scale.data());
  }

 protected:
  static POINTREEL_INLINE Lanes clamped(const Lanes& x, float least, float most) {
    return larger(smaller(x, all<kExperts>(most)), all<kExperts>(least));
  }
  static POINTREEL_INLINE Lanes signed_cdf(const Lanes& z) {
    const Lanes one = all<kExperts>(1);
    const Lanes size = absolute(z);
    return z * (one + size) / (one + size * (one + size));
  }

  Lanes proposals_m_;
  Lanes weight_;         // their sum is 1 / per_total_weight_
  Lanes inverse_scale_;  // per metre
  float per_total_weight_;

 private:
  // Scales are learnt relative to the expert's recent error.
  POINTREEL_INLINE Mixture(const MixtureState& state, std::size_t error_class,
                           const BlendedProposals<kExperts>& blended, std::size_t cell)
      : proposals_m_(load_turned<kExperts>(blended.range_m, cell)),
        weight_(load<kExperts>(state.classes[error_class].weight.data())),
        inverse_scale_(load<kExperts>(state.classes[error_class].inverse_scale.data()) *
                       load_turned<kExperts>(blended.inverse_scale, cell)),
        per_total_weight_(1 / sum(weight_)),
        error_class_(error_class) {}

  std::size_t error_class_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
