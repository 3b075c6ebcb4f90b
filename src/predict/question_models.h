// The adaptive models behind the questions about a bin at effort max.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/bit_mixer.h"
#include "predict/mixer_weights.h"
#include "predict/range_state.h"

namespace pointreel {

// Of one kind of question: adaptive bits, each in a context of its own, and two mixers, each with weights by
// another context, whose answers are averaged.
struct QuestionModels {
  static constexpr std::size_t kContexts = 6, kMixers = 2;
  static constexpr std::size_t kInputs = 2 + kContexts;  // the mixture's answer and a constant, too

  std::array<std::vector<CountedBit>, kContexts> bits;
  std::array<std::vector<MixerWeights<kInputs>>, kMixers> mixers;
};

// Contexts: two of a question's own, then where four triples of proposals lie (max_second_stage-inl.h).
struct MaxQuestionModels {
  static constexpr std::size_t kOwn = 2;
  static constexpr std::size_t kOwnByRow = 1;  // of them, but for kMore
  static constexpr std::size_t kTriples = std::size_t{7} * 7 * 7;
  static constexpr std::size_t kUnarySteps = 6;
  static constexpr std::size_t kByRow = StepModels::kRows * StepModels::kAvailabilities;
  enum Kind : std::uint8_t { kZero, kSign, kMore, kKinds };
  static constexpr std::array<std::array<std::size_t, kOwn>, kKinds> kOwnContexts = {
      {{StepModels::kActivities * StepModels::kErrors, kByRow},
       {StepModels::kSigns, kByRow},
       {StepModels::kErrors * kUnarySteps, StepModels::kErrors* kUnarySteps}}};
  static constexpr std::array<std::array<std::size_t, QuestionModels::kMixers>, kKinds> kMixerContexts = {
      {{StepModels::kActivities * StepModels::kAvailabilities, kMostExperts},
       {StepModels::kAvailabilities, kMostExperts},
       {kUnarySteps * 4, StepModels::kErrors}}};

  std::array<QuestionModels, kKinds> of;
};

}  // namespace pointreel
