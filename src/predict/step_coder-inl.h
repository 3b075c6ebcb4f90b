// Codes which bin of the quantiser a range falls into, by yes-or-no questions outward from the predicted one.
//
// The mixture answers each question with a probability; for the first few a second stage corrects what the
// mixture gets wrong systematically under the same circumstances.

#if defined(POINTREEL_PREDICT_STEP_CODER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_STEP_CODER_INL_H_
#undef POINTREEL_PREDICT_STEP_CODER_INL_H_
#else
#define POINTREEL_PREDICT_STEP_CODER_INL_H_
#endif

#include <utility>

#include "predict/bit_mixing-inl.h"
#include "predict/mixture-inl.h"
#include "predict/step_context-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

POINTREEL_INLINE float positive(float x) {
  return x > 1e-9F ? x : 1e-9F;
}

POINTREEL_INLINE Probability16 to_probability(float p) {
  constexpr float kLeast = kMinProbability, kMost = 65536 - kMinProbability;
  return static_cast<Probability16>(static_cast<std::int32_t>(clamped(p * 65536, kLeast, kMost)));
}

// `weight`: of the mixture's answer `p`.
template <class Coder, std::size_t kTerms>
POINTREEL_INLINE bool code_corrected(Coder& coder, bool second_stage, float p, float* const (&terms)[kTerms],
                                     float& weight, bool bit) {
  if (!second_stage) return coder.code_with(bit, to_probability(p));
  constexpr float kTermRate = 0.01F, kWeightRate = 1.F / 256;
  const float answer = stretched(p);
  float move = 0;
  bit = code_sum(coder, weight * answer, terms, kTermRate, bit, move);
  weight = weight + kWeightRate / kTermRate * move * answer;
  return bit;
}

// The bins of one cell, as far as they are looked at.
template <class Mixture>
class Bins {
 public:
  using Border = typename Mixture::Border;

  POINTREEL_INLINE Bins() {}
  // Bin 0 is the one around `origin_m`.
  POINTREEL_INLINE void start(const Mixture& mixture, float origin_m, float step_m) {
    mixture_ = mixture;
    origin_m_ = origin_m;
    step_m_ = step_m;
    lower = &borders_[0];
    upper = &borders_[1];
    spare = &borders_[2];
    evaluate(-0.5F, *lower);
    evaluate(0.5F, *upper);
  }
  // The border `steps` from the origin.
  POINTREEL_INLINE void evaluate(float steps, Border& border) const {
    mixture_.evaluate(origin_m_ + steps * step_m_, border);
  }
  // The coded bin is then the one between `lower` and `upper`.
  const Mixture& mixture() const { return mixture_; }
  float origin_m() const { return origin_m_; }

  Border *lower, *upper, *spare;

 private:
  Border borders_[3];
  Mixture mixture_;
  float origin_m_;
  float step_m_;
};

// Answers the questions about one cell: the second stage over the mixture's answers.
class SecondStage {
 public:
  static constexpr std::size_t kUnarySteps = StepModels::kUnarySteps;

  POINTREEL_INLINE SecondStage(StepModels& models, const StepContext& at, bool in_use)
      : models_(models), at_(at), in_use_(in_use) {}

  template <class Coder>
  POINTREEL_INLINE bool code_zero(Coder& coder, float p, bool zero) const {
    return code_corrected(
        coder, in_use_, p,
        {&models_.zero_by_activity[at_.activity * StepModels::kErrors + at_.error],
         &models_.zero_by_spread[at_.spread * StepModels::kErrors + at_.error],
         &models_.zero_by_row[at_.row * StepModels::kAvailabilities + at_.availability],
         &models_.zero_by_places[0][at_.places[0]], &models_.zero_by_places[1][at_.places[1]]},
        models_.zero_weight[at_.activity * StepModels::kAvailabilities + at_.availability], zero);
  }
  template <class Coder>
  POINTREEL_INLINE bool code_sign(Coder& coder, float p, bool down) const {
    return code_corrected(
        coder, in_use_, p,
        {&models_.sign_by_signs[at_.signs],
         &models_.sign_by_row[at_.row * StepModels::kAvailabilities + at_.availability],
         &models_.sign_by_places[0][at_.places[0]], &models_.sign_by_places[1][at_.places[1]]},
        models_.sign_weight[at_.availability], down);
  }
  template <class Coder>
  POINTREEL_INLINE bool code_more(Coder& coder, std::int32_t direction, std::int32_t magnitude, float p,
                                  bool more) const {
    const auto step = static_cast<std::size_t>(magnitude - 1);
    const std::size_t by_step = (direction < 0 ? StepModels::kUnarySteps : 0) + step;
    return code_corrected(coder, in_use_, p,
                          {&models_.more_by_error[at_.error * StepModels::kUnarySteps + step],
                           &models_.more_by_spread[at_.spread * StepModels::kUnarySteps + step],
                           &models_.more_by_places[0][at_.places[0] * 2 * StepModels::kUnarySteps + by_step],
                           &models_.more_by_places[1][at_.places[1] * 2 * StepModels::kUnarySteps + by_step]},
                          models_.more_weight[step * 4 + at_.activity / 4], more);
  }

 private:
  StepModels& models_;
  const StepContext& at_;
  bool in_use_;
};

// The questions about one cell, which `Stage` answers.
template <class Coder, class Mixture, class Stage>
class StepCoder {
 public:
  using Border = typename Mixture::Border;

  POINTREEL_INLINE StepCoder(Coder& coder, Bins<Mixture>& bins, const Stage& stage)
      : coder_(coder), bins_(bins), stage_(stage) {}

  // Codes `wanted` (ignored when decoding) and returns it. The bins' lower and upper are then the borders of
  // its bin.
  POINTREEL_INLINE std::int32_t code(std::int32_t wanted) {
    const float below = bins_.lower->mixed, above = bins_.upper->mixed;
    if (stage_.code_zero(coder_, 0.5F * (above - below), wanted == 0)) return 0;
    const float tail_below = positive(1 + below), tail_above = positive(1 - above);
    const bool down = stage_.code_sign(coder_, tail_below / (tail_below + tail_above), wanted < 0);
    // From here on the inner border is the one nearer to the prediction; the outer one is found anew.
    Border* inner = down ? bins_.lower : bins_.upper;
    Border* outer = down ? bins_.upper : bins_.lower;
    const std::int32_t direction = down ? -1 : 1;
    const std::int32_t magnitude =
        code_magnitude(direction, wanted * direction, down ? tail_below : tail_above, inner, outer);
    bins_.lower = down ? outer : inner;
    bins_.upper = down ? inner : outer;
    return magnitude * direction;
  }

 private:
  static constexpr auto kUnarySteps = static_cast<std::int32_t>(Stage::kUnarySteps);
  static constexpr std::int32_t kMostSteps = 1 << 26;

  // Twice the probability of larger magnitudes than this; its far border is evaluated into `outer`.
  POINTREEL_INLINE float tail_beyond(std::int32_t direction, std::int32_t magnitude, Border& outer) const {
    const auto side = static_cast<float>(direction);
    bins_.evaluate(side * (static_cast<float>(magnitude) + 0.5F), outer);
    return positive(1 - side * outer.mixed);
  }

  HWY_NOINLINE std::int32_t code_magnitude(std::int32_t direction, std::int32_t wanted, float tail,
                                           Border*& inner, Border*& outer) {
    std::int32_t magnitude = 1;
    for (; magnitude <= kUnarySteps; ++magnitude) {
      const float beyond = tail_beyond(direction, magnitude, *outer);
      if (!stage_.code_more(coder_, direction, magnitude, beyond / tail, wanted > magnitude))
        return magnitude;
      std::swap(inner, outer);
      tail = beyond;
    }
    // At least kUnarySteps + 1: widening intervals, then halving the one that holds it.
    std::int32_t width = 2;
    float beyond = tail_beyond(direction, magnitude + width - 1, *outer);
    while (magnitude + width <= kMostSteps &&
           coder_.code_with(wanted >= magnitude + width, to_probability(beyond / tail))) {
      magnitude += width;
      std::swap(inner, outer);
      tail = beyond;
      width *= 2;
      beyond = tail_beyond(direction, magnitude + width - 1, *outer);
    }
    Border*& middle = bins_.spare;
    while (width > 1) {
      width /= 2;
      const float from_middle = tail_beyond(direction, magnitude + width - 1, *middle);
      const float farther = positive(from_middle - beyond);
      const float nearer = positive(tail - from_middle);
      if (coder_.code_with(wanted >= magnitude + width, to_probability(farther / (farther + nearer)))) {
        magnitude += width;
        std::swap(inner, middle);
        tail = from_middle;
      } else {
        std::swap(outer, middle);
        beyond = from_middle;
      }
    }
    return magnitude;
  }

  Coder& coder_;
  Bins<Mixture>& bins_;
  const Stage& stage_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
