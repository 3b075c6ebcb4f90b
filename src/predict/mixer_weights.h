// Weights with which several predictions of one bit are mixed (max_second_stage-inl.h).
#pragma once

#include <array>
#include <cstddef>

namespace pointreel {

template <std::size_t kInputs>
struct MixerWeights {
  std::array<float, kInputs> weight{};
};

}  // namespace pointreel
