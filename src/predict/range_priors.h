// What the range model knows before its first sweep; made by bench/train_range_model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "predict/range_state.h"

namespace pointreel {

// One set of priors per size of the step.
inline constexpr std::array<float, 9> kPriorSteps = {0.002F, 0.005F, 0.01F, 0.02F, 0.04F, 0.1F, 0.2F, 0.4F, 1.0F};

struct RangePriors {
  // Weights and inverse scales: logarithms in eighths of an octave.
  std::array<std::int8_t, kErrorClasses * kExperts> weight, inverse_scale;
  // As in hit_mask_priors.h; the models by row have one prior for all rows.
  std::array<std::uint8_t, StepModels::kActivities * StepModels::kErrors> zero_by_activity;
  std::array<std::uint8_t, 4> zero_by_row, sign_by_row;
  std::array<std::uint8_t, StepModels::kSigns> sign_by_signs;
  std::array<std::uint8_t, StepModels::kErrors * StepModels::kUnarySteps> more_by_error;
  // In units of 1/256.
  std::array<std::int16_t, 3 * 4 * StepModels::kActivities> zero_mixers;
  std::array<std::int16_t, 3 * 4> sign_mixers;
  std::array<std::int16_t, 2 * 4 * StepModels::kUnarySteps> more_mixers;
};

extern const std::array<RangePriors, kPriorSteps.size()> kRangePriors;

// The set for a step: the nearest one by ratio.
constexpr std::size_t prior_set(float step_m) {
  std::size_t set = 0;
  while (set + 1 < kPriorSteps.size() && step_m * step_m > kPriorSteps[set] * kPriorSteps[set + 1]) ++set;
  return set;
}

}  // namespace pointreel
