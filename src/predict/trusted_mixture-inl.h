// The mixture of effort max: weights and scales of the experts are products over the circumstances of a cell
// (expert_trust.h), its bins lie where one of them is likeliest, and what it makes of a coded bin is more
// than its middle.

#if defined(POINTREEL_PREDICT_TRUSTED_MIXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_TRUSTED_MIXTURE_INL_H_
#undef POINTREEL_PREDICT_TRUSTED_MIXTURE_INL_H_
#else
#define POINTREEL_PREDICT_TRUSTED_MIXTURE_INL_H_
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "predict/expert_trust.h"
#include "predict/mixture-inl.h"
#include "predict/step_context-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// The classes of a cell's circumstances.
using TrustClasses = std::array<std::size_t, ExpertTrusts::kCircumstances>;

// `column`, of `columns`, may lie in the margin.
POINTREEL_INLINE TrustClasses trust_classes(const StepContext& context, std::int32_t error_class,
                                            float blend_m, int column, int columns) {
  // Octaves of 1 + range.
  constexpr auto kOctaves = static_cast<std::int32_t>(ExpertTrusts::kDistances) - 1;
  const auto bits = std::bit_cast<std::int32_t>(1 + blend_m);
  const std::int32_t half_octaves = std::clamp((bits >> 22) - (127 << 1), 0, kOctaves);
  const int sector = column * static_cast<int>(ExpertTrusts::kSectors) / columns;
  constexpr std::size_t kSpreadsApart = StepModels::kErrors / ExpertTrusts::kSpreads;
  TrustClasses classes;
  classes[ExpertTrusts::kError] = static_cast<std::size_t>(error_class);
  classes[ExpertTrusts::kAround] = context.activity * StepModels::kAvailabilities + context.availability;
  classes[ExpertTrusts::kDistance] =
      static_cast<std::size_t>(half_octaves) * ExpertTrusts::kSpreads + context.spread / kSpreadsApart;
  classes[ExpertTrusts::kRow] = context.row;
  classes[ExpertTrusts::kSector] =
      static_cast<std::size_t>(std::clamp(sector, 0, static_cast<int>(ExpertTrusts::kSectors) - 1));
  return classes;
}

class TrustedMixture : public Mixture<kMostExperts> {
 public:
  // A proposal around which to lay the bins.
  struct Origin {
    std::size_t expert;
    float range_m;
  };

  POINTREEL_INLINE TrustedMixture() {}
  POINTREEL_INLINE TrustedMixture(const ExpertTrusts& trusts, const BlendedProposals<kMostExperts>& blended,
                                  std::size_t cell, const TrustClasses& classes)
      : classes_(classes) {
    proposals_m_ = load_turned<kMostExperts>(blended.range_m, cell);
    inverse_scale_ = load_turned<kMostExperts>(blended.inverse_scale, cell);
    weight_ = all<kMostExperts>(1);
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const ExpertTrust& trust = trusts.of[i][classes[i]];
      weight_ = weight_ * load<kMostExperts>(trust.weight.data());
      inverse_scale_ = inverse_scale_ * load<kMostExperts>(trust.inverse_scale.data());
    }
    per_total_weight_ = 1 / sum(weight_);
  }

  // Of the blend and the experts that find themselves likeliest, the one around which a bin is likeliest:
  // bins around a surface that goes on keep it smooth.
  POINTREEL_INLINE Origin likeliest_origin(float step_m) const {
    constexpr int kCandidates = 2;
    alignas(64) float proposals_m[kMostExperts];
    store(proposals_m_, proposals_m);
    const Lanes half_bin = all<kMostExperts>(0.5F * step_m) * inverse_scale_;
    Lanes own = weight_ * signed_cdf(half_bin);
    Origin best{0, proposals_m[0]};
    float most = mass_around(best.range_m, half_bin);
    for (int i = 0; i < kCandidates; ++i) {
      const float likeliest = largest(own);
      const std::size_t expert = first_lane_with(own, likeliest);
      own = where(own < all<kMostExperts>(likeliest), own);
      const float mass = mass_around(proposals_m[expert], half_bin);
      if (!(mass > most)) continue;
      most = mass;
      best = {expert, proposals_m[expert]};
    }
    return best;
  }

  // Proposals in steps from the origin of the bins, rounded.
  POINTREEL_INLINE Ints<kMostExperts> steps_from(float origin_m, float per_step) const {
    constexpr float kMost = 1000;
    const Lanes steps = (proposals_m_ - all<kMostExperts>(origin_m)) * all<kMostExperts>(per_step);
    // Conversions truncate: halves round up where all is positive.
    return truncated(clamped(steps, -kMost, kMost) + all<kMostExperts>(kMost + 0.5F)) +
           all_ints<kMostExperts>(-static_cast<std::int32_t>(kMost));
  }

  // Moves the trust in the experts, as Mixture::learn() moves the mixture. Gives back where in the coded bin
  // around `middle_m` they take the range to be: what later cells are predicted from.
  POINTREEL_INLINE float learn(const Border& lower, const Border& upper, float middle_m, float step_m,
                               ExpertTrusts& trusts) const {
    constexpr float kWeightRate = 0.12F, kScaleRate = 0.05F;
    constexpr float kReach = 0.35F;  // of the step, to either side of the middle
    // Of one factor: products stay within the floats.
    constexpr float kMostWeight = 4096, kMostScale = 16;
    const Lanes one = all<kMostExperts>(1);
    const Lanes p = larger(upper.signed_cdf - lower.signed_cdf, all<kMostExperts>(1e-9F));
    const Lanes steepness = larger(smaller((upper.slope - lower.slope) / p, one), all<kMostExperts>(-4));
    const Lanes joint = weight_ * p;
    const Lanes responsibility = joint * all<kMostExperts>(1 / sum(joint));
    const Lanes weight_factor = one + kWeightRate * (responsibility - per_total_weight_ * weight_);
    const Lanes scale_factor = one + kScaleRate * (responsibility * steepness);
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      ExpertTrust& trust = trusts.of[i][classes_[i]];
      store(clamped(load<kMostExperts>(trust.weight.data()) * weight_factor, 1 / kMostWeight, kMostWeight),
            trust.weight.data());
      store(
          clamped(load<kMostExperts>(trust.inverse_scale.data()) * scale_factor, 1 / kMostScale, kMostScale),
          trust.inverse_scale.data());
    }
    const float reach_m = kReach * step_m;
    return sum(responsibility * clamped(proposals_m_, middle_m - reach_m, middle_m + reach_m));
  }

 private:
  POINTREEL_INLINE float mass_around(float x_m, const Lanes& half_bin) const {
    const Lanes z = (all<kMostExperts>(x_m) - proposals_m_) * inverse_scale_;
    return sum(weight_ * (signed_cdf(z + half_bin) - signed_cdf(z - half_bin)));
  }

  TrustClasses classes_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
