// Everything that the range model learns at effort max.
#pragma once

#include <cstddef>

#include "predict/expert_trust.h"
#include "predict/question_models.h"

namespace pointreel {

// Empty unless it is in use: other efforts copy it, too.
struct MaxRangeState {
  ExpertTrusts trusts;
  MaxQuestionModels questions;

  void make() {
    for (std::size_t i = 0; i < trusts.of.size(); ++i) {
      ExpertTrust even;
      even.weight.fill(1);
      even.inverse_scale.fill(1);
      trusts.of[i].assign(ExpertTrusts::kClasses[i], even);
    }
    for (std::size_t kind = 0; kind < MaxQuestionModels::kKinds; ++kind) {
      QuestionModels& question = questions.of[kind];
      for (std::size_t i = 0; i < QuestionModels::kContexts; ++i)
        question.bits[i].resize(i < MaxQuestionModels::kOwn ? MaxQuestionModels::kOwnContexts[kind][i]
                                                            : MaxQuestionModels::kTriples);
      for (std::size_t i = 0; i < QuestionModels::kMixers; ++i)
        question.mixers[i].resize(MaxQuestionModels::kMixerContexts[kind][i]);
    }
  }
};

// Shows a visitor what has priors, in the order of their tables (priors.h).
template <class State, class Visitor>
void visit_max_range_state(State& state, Visitor& visitor) {
  for (std::size_t i = 0; i < ExpertTrusts::kWithPriors; ++i) {
    for (auto& trust : state.trusts.of[i]) {
      for (auto& weight : trust.weight) visitor.logarithm(weight);
      for (auto& inverse_scale : trust.inverse_scale) visitor.logarithm(inverse_scale);
    }
  }
  for (std::size_t kind = 0; kind < MaxQuestionModels::kKinds; ++kind) {
    auto& question = state.questions.of[kind];
    for (std::size_t i = 0; i < QuestionModels::kContexts; ++i) {
      auto& bits = question.bits[i];
      if (i == MaxQuestionModels::kOwnByRow && kind != MaxQuestionModels::kMore) {
        visitor.bits_by_row(bits.data(), StepModels::kRows, StepModels::kAvailabilities);
      } else {
        for (auto& bit : bits) visitor.bit(bit);
      }
    }
    for (auto& mixers : question.mixers) {
      for (auto& mixer : mixers) {
        for (auto& weight : mixer.weight) visitor.weight(weight);
      }
    }
  }
}

}  // namespace pointreel
