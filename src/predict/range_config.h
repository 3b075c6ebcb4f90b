// Which ingredients of the range model are in use. Streams have all of them; the ablation benchmark leaves
// some out to see what they are worth.
#pragma once

#include <cstdint>

namespace pointreel {

struct AllIngredients {
  static constexpr std::uint32_t kExpertsOff = 0;  // a bit per expert, which then proposes the first guess
  static constexpr bool kLearnsWeights = true;     // of the mixture
  static constexpr bool kLearnsScales = true;
  static constexpr bool kSecondStage = true;
};

}  // namespace pointreel
