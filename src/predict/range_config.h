// Which ingredients of the range model are in use. Streams have all of them; the ablation benchmark leaves
// some out to see what they are worth. Efforts fast and max have models of their own, which only heed
// experts_off (max).
#pragma once

#include <cstdint>

namespace pointreel {

struct Ingredients {
  std::uint32_t experts_off = 0;  // a bit per expert, which then proposes the first guess
  float weight_rate = 0.2F;       // how fast the mixture's weights and scales learn
  float scale_rate = 0.08F;
  bool second_stage = true;
};

}  // namespace pointreel
