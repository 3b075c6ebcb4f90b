// Everything that the range model learns while it codes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/bit_mixer.h"

namespace pointreel {

inline constexpr std::size_t kExperts = 16;

// An expert's class: half octaves of its recent mean squared error over the squared step.
inline constexpr std::size_t kErrorClasses = 32;
inline constexpr std::int32_t kFirstClassLog2 = -10;

// Weight and scale of an expert in the mixture, by its class.
struct MixtureState {
  struct PerClass {
    std::array<float, kExperts> weight;
    std::array<float, kExperts> inverse_scale;  // in 1 / step
  };
  std::array<PerClass, kErrorClasses> classes;

  static MixtureState untrained() {
    MixtureState state;
    for (PerClass& at : state.classes) {
      at.weight.fill(1);
      at.inverse_scale.fill(5);
    }
    return state;
  }
};

// The second stage: adaptive models of the first questions about a bin, and the mixers over them.
struct StepModels {
  static constexpr std::size_t kUnarySteps = 6;
  static constexpr std::size_t kRows = 64;    // rows below share the last row's models
  static constexpr std::size_t kErrors = 16;  // classes of errors
  static constexpr std::size_t kActivities = 16;
  static constexpr std::size_t kSigns = 125;

  std::array<CountedBit, kActivities * kErrors> zero_by_activity;
  std::array<CountedBit, kRows * 4> zero_by_row;
  std::array<CountedBit, kSigns> sign_by_signs;
  std::array<CountedBit, kRows * 4> sign_by_row;
  std::array<CountedBit, kErrors * kUnarySteps> more_by_error;
  std::array<BitMixer<3>, 4 * kActivities> zero_mixers;
  std::array<BitMixer<3>, 4> sign_mixers;
  std::array<BitMixer<2>, 4 * kUnarySteps> more_mixers;

  // The mixture has all the say at first.
  StepModels() {
    for (auto& mixer : zero_mixers) mixer.set_weight(0, mixer.kOne);
    for (auto& mixer : sign_mixers) mixer.set_weight(0, mixer.kOne);
    for (auto& mixer : more_mixers) mixer.set_weight(0, mixer.kOne);
  }
};

struct RangeModelState {
  MixtureState mixture = MixtureState::untrained();
  StepModels steps;

  // As trained offline by bench/train_range_model, for steps of about this size.
  static RangeModelState from_priors(float step_m);
};

}  // namespace pointreel
