// Everything that the range model learns while it codes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "predict/coding_kind.h"

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
  };
  std::array<PerClass, kErrorClasses> classes;
};

// What the second stage has learnt about the first questions about a bin: by how much it corrects the
// mixture's answers, in ln(p / (1 - p)).
struct StepModels {
  static constexpr std::size_t kUnarySteps = 3;
  static constexpr std::size_t kRows = 64;    // rows below share the last row's models
  static constexpr std::size_t kErrors = 16;  // classes of errors
  static constexpr std::size_t kActivities = 16;
  static constexpr std::size_t kSigns = 125;
  static constexpr std::size_t kAvailabilities = 4;
  static constexpr std::size_t kPlaces = 2,
                               kTriples = std::size_t{7} * 7 * 7;  // where triples of proposals lie

  std::array<float, kActivities * kErrors> zero_by_activity{};
  std::array<float, kErrors * kErrors> zero_by_spread{};  // of the proposals
  std::array<float, kRows * kAvailabilities> zero_by_row{};
  std::array<std::array<float, kTriples>, kPlaces> zero_by_places{};
  std::array<float, kSigns> sign_by_signs{};
  std::array<float, kRows * kAvailabilities> sign_by_row{};
  std::array<std::array<float, kTriples>, kPlaces> sign_by_places{};
  std::array<float, kErrors * kUnarySteps> more_by_error{};
  std::array<float, kErrors * kUnarySteps> more_by_spread{};
  std::array<std::array<float, kTriples * 2 * kUnarySteps>, kPlaces> more_by_places{};
  // Of the mixture's answer itself.
  std::array<float, kAvailabilities * kActivities> zero_weight{};
  std::array<float, kAvailabilities> sign_weight{};
  std::array<float, kUnarySteps * 4> more_weight{};
};

struct RangeModelState {
  MixtureState mixture;
  StepModels steps;
};

// Shows a visitor all that adapts, in the order of the tables of priors (priors.h).
template <class State, class Visitor>
void visit_range_state(State& state, const CodingKind& kind, Visitor& visitor) {
  const std::size_t experts = mixed_of(kind);
  for (auto& at : state.mixture.classes) {
    for (std::size_t k = 0; k < experts; ++k) visitor.logarithm(at.weight[k]);
    for (std::size_t k = 0; k < experts; ++k) visitor.logarithm(at.inverse_scale[k]);
  }
  const auto visit_all = [&](auto& weights) {
    for (auto& weight : weights) visitor.weight(weight);
  };
  const auto visit_rows = [&](auto& weights) {
    visitor.weights_by_row(weights.data(), StepModels::kRows, StepModels::kAvailabilities);
  };
  auto& steps = state.steps;
  visit_all(steps.zero_by_activity);
  visit_all(steps.zero_by_spread);
  visit_rows(steps.zero_by_row);
  for (auto& places : steps.zero_by_places) visit_all(places);
  visit_all(steps.sign_by_signs);
  visit_rows(steps.sign_by_row);
  for (auto& places : steps.sign_by_places) visit_all(places);
  visit_all(steps.more_by_error);
  visit_all(steps.more_by_spread);
  for (auto& places : steps.more_by_places) visit_all(places);
  visit_all(steps.zero_weight);
  visit_all(steps.sign_weight);
  visit_all(steps.more_weight);
}

}  // namespace pointreel
