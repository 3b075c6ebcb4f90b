// The second stage of effort max: adaptive bits in more contexts, and two mixers over them. Where the
// experts' proposals lie among the bins says most.

#if defined(POINTREEL_PREDICT_MAX_SECOND_STAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_MAX_SECOND_STAGE_INL_H_
#undef POINTREEL_PREDICT_MAX_SECOND_STAGE_INL_H_
#else
#define POINTREEL_PREDICT_MAX_SECOND_STAGE_INL_H_
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "predict/bit_mixing-inl.h"
#include "predict/experts-inl.h"
#include "predict/question_models.h"
#include "predict/step_context-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// `slots` and `weights`: of the question's contexts.
template <class Coder>
HWY_NOINLINE bool code_question(Coder& coder, float p, QuestionModels& models,
                                const std::array<std::size_t, QuestionModels::kContexts>& slots,
                                const std::array<std::size_t, QuestionModels::kMixers>& weights, bool bit) {
  constexpr std::size_t kInputs = QuestionModels::kInputs, kFirstBit = kInputs - QuestionModels::kContexts;
  constexpr std::uint32_t kSettledCount = 30;
  constexpr float kConstant = 0.3F;
  constexpr float kMixingRate = 1.F / 256;
  std::array<CountedBit*, QuestionModels::kContexts> bits;
  alignas(32) float values[kInputs];
  values[0] = stretched(p);
  values[1] = kConstant;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    bits[i] = &models.bits[i][slots[i]];
    values[kFirstBit + i] = stretched(*bits[i]);
  }
  const auto inputs = load<kInputs>(values);
  float* weight_a = models.mixers[0][weights[0]].weight.data();
  float* weight_b = models.mixers[1][weights[1]].weight.data();
  const auto a = load<kInputs>(weight_a), b = load<kInputs>(weight_b);
  const float sum_a = sum(a * inputs), sum_b = sum(b * inputs);
  bit = coder.code_with(bit, squashed(0.5F * (sum_a + sum_b)));
  // Each learns from its own error.
  const auto moved = [&](const Floats<kInputs>& weight, float sum) HWY_ATTR {
    return weight + all<kInputs>(coding_error(squashed(sum), bit) * kMixingRate) * inputs;
  };
  store(moved(a, sum_a), weight_a);
  store(moved(b, sum_b), weight_b);
  for (CountedBit* model : bits) model->template update<kSettledCount>(bit);
  return bit;
}

// Answers the questions about one cell, as SecondStage does.
class MaxSecondStage {
 public:
  static constexpr std::size_t kUnarySteps = MaxQuestionModels::kUnarySteps;

  // `proposed`: where the experts' proposals lie, in steps from the origin of the bins, which is one of them.
  POINTREEL_INLINE MaxSecondStage(MaxQuestionModels& models, const StepContext& at,
                                  const Ints<kMostExperts>& proposed, std::size_t origin)
      : models_(models), at_(at), proposed_(proposed), origin_(origin) {}

  template <class Coder>
  POINTREEL_INLINE bool code_zero(Coder& coder, float p, bool zero) const {
    return code(coder, MaxQuestionModels::kZero, p, at_.activity * StepModels::kErrors + at_.error, by_row(),
                {at_.activity * StepModels::kAvailabilities + at_.availability, origin_}, proposed_, zero);
  }
  template <class Coder>
  POINTREEL_INLINE bool code_sign(Coder& coder, float p, bool down) const {
    return code(coder, MaxQuestionModels::kSign, p, at_.signs, by_row(), {at_.availability, origin_},
                proposed_, down);
  }
  template <class Coder>
  POINTREEL_INLINE bool code_more(Coder& coder, std::int32_t direction, std::int32_t magnitude, float p,
                                  bool more) const {
    const auto step = static_cast<std::size_t>(magnitude - 1);
    const auto farther = proposed_ * all_ints<kMostExperts>(direction) - all_ints<kMostExperts>(magnitude);
    return code(coder, MaxQuestionModels::kMore, p, at_.error * kUnarySteps + step,
                at_.spread * kUnarySteps + step, {step * 4 + at_.activity / 4, at_.error}, farther, more);
  }

 private:
  POINTREEL_INLINE std::size_t by_row() const {
    return at_.row * StepModels::kAvailabilities + at_.availability;
  }

  template <class Coder>
  POINTREEL_INLINE bool code(Coder& coder, MaxQuestionModels::Kind kind, float p, std::size_t own0,
                             std::size_t own1,
                             const std::array<std::size_t, QuestionModels::kMixers>& weights,
                             const Ints<kMostExperts>& proposed, bool bit) const {
    // Seven places: the asked bin, the two on either side, and those beyond.
    const auto three = all_ints<kMostExperts>(3);
    alignas(32) std::int32_t place[kMostExperts];
    store(larger(smaller(proposed, three), all_ints<kMostExperts>(-3)) + three, place);
    const auto triple = [&](int a, int b, int c) HWY_ATTR {
      return static_cast<std::size_t>((place[a] * 7 + place[b]) * 7 + place[c]);
    };
    return code_question(
        coder, p, models_.of[kind],
        {own0, own1, triple(kReferenceHere, kLeft, kAbove), triple(kPlane, kReferenceMean, kLine),
         triple(kReferenceRight, kReferenceLeft, kReferenceBelow),
         triple(kEdge, kPredictedLeft2, kAboveRight)},
        weights, bit);
  }

  MaxQuestionModels& models_;
  const StepContext& at_;
  const Ints<kMostExperts>& proposed_;
  std::size_t origin_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
