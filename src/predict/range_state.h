// Everything that the range model learns while it codes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/bit_mixer.h"
#include "predict/coding_kind.h"
#include "predict/mixer_weights.h"

namespace pointreel {

inline constexpr std::size_t kMostExperts = 16;

// An expert's class: half octaves of its recent mean squared error over the squared step.
inline constexpr std::size_t kErrorClasses = 32;
inline constexpr std::int32_t kFirstClassLog2 = -10;

// Weight and scale of an expert in the mixture, by the class of the blend.
struct MixtureState {
  struct PerClass {
    std::array<float, kMostExperts> weight{};
    std::array<float, kMostExperts> inverse_scale{};  // in 1 / step
    float per_total_weight = 1;
  };
  std::array<PerClass, kErrorClasses> classes;
};

// Adaptive models of the first questions about a bin, and the mixers over them.
struct StepModels {
  static constexpr std::size_t kUnarySteps = 6;
  static constexpr std::size_t kRows = 64;    // rows below share the last row's models
  static constexpr std::size_t kErrors = 16;  // classes of errors
  static constexpr std::size_t kActivities = 16;
  static constexpr std::size_t kSigns = 125;
  static constexpr std::size_t kAvailabilities = 4;

  std::array<CountedBit, kActivities * kErrors> zero_by_activity;
  std::array<CountedBit, kErrors * kErrors> zero_by_spread;  // of the proposals
  std::array<CountedBit, kRows * kAvailabilities> zero_by_row;
  std::array<CountedBit, kSigns> sign_by_signs;
  std::array<CountedBit, kRows * kAvailabilities> sign_by_row;
  std::array<CountedBit, kErrors * kUnarySteps> more_by_error;
  std::array<CountedBit, kErrors * kUnarySteps> more_by_spread;
  std::array<MixerWeights<4>, kAvailabilities * kActivities> zero_mixers;
  std::array<MixerWeights<3>, kAvailabilities> sign_mixers;
  std::array<MixerWeights<3>, kUnarySteps * 4> more_mixers;
};

struct RangeModelState {
  MixtureState mixture;
  StepModels steps;
};

// Shows a visitor all that adapts, in the order of the tables of priors (priors.h).
template <class State, class Visitor>
void visit_range_state(State& state, const CodingKind& kind, Visitor& visitor) {
  const std::size_t experts = experts_of(kind);
  for (auto& at : state.mixture.classes) {
    for (std::size_t k = 0; k < experts; ++k) visitor.logarithm(at.weight[k]);
    for (std::size_t k = 0; k < experts; ++k) visitor.logarithm(at.inverse_scale[k]);
  }
  auto& steps = state.steps;
  for (auto& bit : steps.zero_by_activity) visitor.bit(bit);
  for (auto& bit : steps.zero_by_spread) visitor.bit(bit);
  visitor.bits_by_row(steps.zero_by_row.data(), StepModels::kRows, StepModels::kAvailabilities);
  for (auto& bit : steps.sign_by_signs) visitor.bit(bit);
  visitor.bits_by_row(steps.sign_by_row.data(), StepModels::kRows, StepModels::kAvailabilities);
  for (auto& bit : steps.more_by_error) visitor.bit(bit);
  for (auto& bit : steps.more_by_spread) visitor.bit(bit);
  const auto visit_weights = [&](auto& mixers) {
    for (auto& mixer : mixers) {
      for (auto& weight : mixer.weight) visitor.weight(weight);
    }
  };
  visit_weights(steps.zero_mixers);
  visit_weights(steps.sign_mixers);
  visit_weights(steps.more_mixers);
}

}  // namespace pointreel
