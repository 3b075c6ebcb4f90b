// Codes which bin of the quantiser a range falls into, by yes-or-no questions outward from the predicted one.
//
// The mixture answers each question with a probability; for the first few a second stage mixes it with what
// adaptive models have seen under the same circumstances, which corrects what the mixture gets wrong
// systematically.

#if defined(POINTREEL_PREDICT_STEP_CODER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_STEP_CODER_INL_H_
#undef POINTREEL_PREDICT_STEP_CODER_INL_H_
#else
#define POINTREEL_PREDICT_STEP_CODER_INL_H_
#endif

#include <utility>

#include "predict/mixture-inl.h"
#include "predict/step_context.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

HWY_INLINE float positive(float x) {
  return x > 1e-9F ? x : 1e-9F;
}

HWY_INLINE Probability16 to_probability(float p) {
  constexpr float kLeast = kMinProbability, kMost = 65536 - kMinProbability;
  const float scaled = p * 65536;
  return static_cast<Probability16>(scaled > kLeast ? (scaled < kMost ? scaled : kMost) : kLeast);
}

template <class Ingredients, class Coder, std::size_t kModels>
HWY_INLINE bool code_mixed(Coder& coder, float p, CountedBit* const (&models)[kModels],
                           BitMixer<kModels + 1>& mixer, bool bit) {
  if constexpr (!Ingredients::kSecondStage) return coder.code_with(bit, to_probability(p));
  constexpr std::uint32_t kSettledCount = 60;
  constexpr int kMixingRateShift = 16;
  typename BitMixer<kModels + 1>::Inputs inputs;
  inputs[0] = stretch(to_probability(p));
  for (std::size_t i = 0; i < kModels; ++i) inputs[i + 1] = models[i]->stretch();
  const Probability16 mixed = mixer.p_one(inputs);
  bit = coder.code_with(bit, mixed);
  mixer.template update<kMixingRateShift>(inputs, mixed, bit);
  for (CountedBit* model : models) model->template update<kSettledCount>(bit);
  return bit;
}

template <class Coder, class Ingredients>
class StepCoder {
 public:
  HWY_INLINE StepCoder(Coder& coder, StepModels& models, const Mixture& mixture, const StepContext& at,
                       float origin_m, float step_m)
      : coder_(coder), models_(models), mixture_(mixture), at_(at), origin_m_(origin_m), step_m_(step_m) {}

  // Codes `wanted` (ignored when decoding) and returns it. `lower` and `upper` become the borders of its bin.
  HWY_INLINE std::int32_t code(std::int32_t wanted, Mixture::Border& lower, Mixture::Border& upper) {
    mixture_.evaluate(border_m(-1), lower);
    mixture_.evaluate(border_m(0), upper);
    if (code_zero(0.5F * (upper.mixed - lower.mixed), wanted == 0)) return 0;
    const float tail_below = positive(1 + lower.mixed);
    const float tail_above = positive(1 - upper.mixed);
    const bool down = code_sign(tail_below / (tail_below + tail_above), wanted < 0);
    // From here on `inner` is the border nearer to the prediction.
    std::swap(lower, upper);
    return down ? -code_magnitude<true>(-wanted, tail_below, upper, lower)
                : code_magnitude<false>(wanted, tail_above, lower, upper);
  }

 private:
  static constexpr auto kUnarySteps = static_cast<std::int32_t>(StepModels::kUnarySteps);
  static constexpr std::int32_t kMostSteps = 1 << 26;

  // Between bins `below` and below + 1.
  HWY_INLINE float border_m(std::int32_t below) const {
    return origin_m_ + (static_cast<float>(below) + 0.5F) * step_m_;
  }
  // Twice the probability of larger magnitudes than this; its far border is evaluated into `outer`.
  template <bool kDown>
  HWY_INLINE float tail_beyond(std::int32_t magnitude, Mixture::Border& outer) const {
    mixture_.evaluate(kDown ? border_m(-magnitude - 1) : border_m(magnitude), outer);
    return positive(kDown ? 1 + outer.mixed : 1 - outer.mixed);
  }

  template <bool kDown>
  std::int32_t code_magnitude(std::int32_t wanted, float tail, Mixture::Border& inner,
                              Mixture::Border& outer) {
    std::int32_t magnitude = 1;
    for (; magnitude <= kUnarySteps; ++magnitude) {
      const float beyond = tail_beyond<kDown>(magnitude, outer);
      if (!code_more(magnitude, beyond / tail, wanted > magnitude)) return magnitude;
      inner = outer;
      tail = beyond;
    }
    // At least kUnarySteps + 1: widening intervals, then halving the one that holds it.
    std::int32_t width = 2;
    float beyond = tail_beyond<kDown>(magnitude + width - 1, outer);
    while (magnitude + width <= kMostSteps &&
           coder_.code_with(wanted >= magnitude + width, to_probability(beyond / tail))) {
      magnitude += width;
      inner = outer;
      tail = beyond;
      width *= 2;
      beyond = tail_beyond<kDown>(magnitude + width - 1, outer);
    }
    Mixture::Border middle;
    while (width > 1) {
      width /= 2;
      const float from_middle = tail_beyond<kDown>(magnitude + width - 1, middle);
      const float farther = positive(from_middle - beyond);
      const float nearer = positive(tail - from_middle);
      if (coder_.code_with(wanted >= magnitude + width, to_probability(farther / (farther + nearer)))) {
        magnitude += width;
        inner = middle;
        tail = from_middle;
      } else {
        outer = middle;
        beyond = from_middle;
      }
    }
    return magnitude;
  }

  HWY_INLINE bool code_zero(float p, bool zero) {
    return code_mixed<Ingredients>(coder_, p,
                                   {&models_.zero_by_activity[at_.activity * StepModels::kErrors + at_.error],
                                    &models_.zero_by_row[at_.row * 4 + at_.availability]},
                                   models_.zero_mixers[at_.activity * 4 + at_.availability], zero);
  }
  HWY_INLINE bool code_sign(float p, bool down) {
    return code_mixed<Ingredients>(
        coder_, p, {&models_.sign_by_signs[at_.signs], &models_.sign_by_row[at_.row * 4 + at_.availability]},
        models_.sign_mixers[at_.availability], down);
  }
  HWY_INLINE bool code_more(std::int32_t magnitude, float p, bool more) {
    const auto step = static_cast<std::size_t>(magnitude - 1);
    return code_mixed<Ingredients>(coder_, p,
                                   {&models_.more_by_error[at_.error * StepModels::kUnarySteps + step]},
                                   models_.more_mixers[step * 4 + at_.activity / 4], more);
  }

  Coder& coder_;
  StepModels& models_;
  const Mixture& mixture_;
  const StepContext& at_;
  float origin_m_;
  float step_m_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
