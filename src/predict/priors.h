// What the models know before their first sweep: trained offline by bench/train_priors, and part of the
// format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "predict/band_coding.h"

namespace pointreel {

// The state at the start of a sweep.
BandState state_from_priors(const CodingKind& kind, float step_m, const Band& band);

// One set of priors per size of the step.
inline constexpr std::array<float, 7> kPriorSteps = {0.002F, 0.007F, 0.02F, 0.04F, 0.1F, 0.2F, 0.4F};

// The set for a step: the nearest one by ratio.
constexpr std::size_t prior_set(float step_m) {
  std::size_t set = 0;
  while (set + 1 < kPriorSteps.size() && step_m * step_m > kPriorSteps[set] * kPriorSteps[set + 1]) ++set;
  return set;
}

// A table has one number for each thing that visit_range_state() or visit_hit_mask_state() shows:
// an adaptive bit: 64 steps of 1/4 in ln(p / (1 - p)), and in the lowest two bits how many bits it counts
// for; a table of symbols: how many it counts for, and a logarithm for each of them; a mixer's weight: in
// units of 1/kPriorsPerWeight; a logarithm: in eighths of an octave.
inline constexpr int kPriorStep = 64;  // in Stretch units
inline constexpr std::array<std::uint8_t, 4> kPriorCounts = {0, 3, 10, 30};
inline constexpr int kPriorsPerWeight = 32;
inline constexpr int kPriorsPerOctave = 8;

// The tables (priors_data.cpp, generated).
std::span<const std::int8_t> hit_mask_priors(const CodingKind& kind);
std::span<const std::int8_t> range_priors(const CodingKind& kind, std::size_t set);

}  // namespace pointreel
