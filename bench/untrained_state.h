// The state of the models before they have learnt anything.
#pragma once

#include <algorithm>

#include "predict/band_coding.h"

namespace pointreel {

// Weights that say nothing, and the mixture's own probability at first.
inline BandState untrained(const CodingKind& kind, int rows) {
  BandState state{HitMaskState(static_cast<std::size_t>(rows)), {}, {}, {}};
  if (kind.effort == Effort::fast) return state;
  if (has_trust(kind)) {
    state.trust.make();
    for (auto& trust : state.trust.trusts.of[ExpertTrusts::kError]) trust.inverse_scale.fill(5);
    for (auto& question : state.trust.questions.of) {
      for (auto& mixers : question.mixers) {
        for (auto& mixer : mixers) mixer.weight[0] = 1;
      }
    }
    return state;
  }
  for (auto& at : state.ranges.mixture.classes) {
    const std::size_t experts = mixed_of(kind);
    std::fill_n(at.weight.begin(), experts, 1.F);
    std::fill_n(at.inverse_scale.begin(), experts, 5.F);
  }
  state.ranges.steps.zero_weight.fill(1);
  state.ranges.steps.sign_weight.fill(1);
  state.ranges.steps.more_weight.fill(1);
  return state;
}

}  // namespace pointreel
