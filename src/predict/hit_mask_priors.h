// What the hit mask's model knows before its first sweep; made by bench/train_hit_mask.
#pragma once

#include <array>
#include <cstdint>

#include "predict/hit_mask.h"

namespace pointreel {

inline constexpr int kHitMaskPriorSlots = [] {
  int sum = 0;
  for (const int slots : HitMaskState::kSlots) sum += slots;
  return sum;
}();

// A slot's prior in one byte: 64 steps of 1/4 in ln(p / (1 - p)), and how many bits it counts for.
inline constexpr int kPriorStep = 64;  // in Stretch units
inline constexpr std::array<std::uint8_t, 4> kPriorCounts = {0, 3, 10, 30};

inline CountedBit bit_from_prior(std::uint8_t prior) {
  return {squash((prior >> 2) * kPriorStep - kMaxStretch + kPriorStep / 2 - 1), kPriorCounts[prior & 3]};
}

extern const std::array<std::uint8_t, kHitMaskPriorSlots> kHitMaskPriors;
// In units of 1/256.
extern const std::array<std::int16_t, HitMaskState::kMixers * HitMaskState::kContexts> kHitMaskWeights;

}  // namespace pointreel
