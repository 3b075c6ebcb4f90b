// What effort max learns about the experts: how far each is to be trusted under the circumstances of a cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "predict/range_state.h"

namespace pointreel {

// Factors of the experts' weights and inverse scales.
struct ExpertTrust {
  std::array<float, kMostExperts> weight{};
  std::array<float, kMostExperts> inverse_scale{};
};

// One for each class of each circumstance; the mixture of a cell takes the product over its circumstances.
struct ExpertTrusts {
  enum Circumstance : std::uint8_t {
    kError,     // the class of the blend's recent error
    kAround,    // the sizes of the steps around, and which neighbours there are
    kDistance,  // the blend's octave, and how far the proposals lie apart
    kRow,
    kSector,  // of the sweep: what is there now will be there in the next sweep
    kCircumstances
  };
  static constexpr std::size_t kSectors = 32;
  static constexpr std::size_t kDistances = 16, kSpreads = 4;
  static constexpr std::array<std::size_t, kCircumstances> kClasses = {
      kErrorClasses, StepModels::kActivities* StepModels::kAvailabilities, kDistances* kSpreads,
      StepModels::kRows, kSectors};
  // Those that do not depend on the sensor and on where it is have priors.
  static constexpr std::size_t kWithPriors = kRow;

  std::array<std::vector<ExpertTrust>, kCircumstances> of;
};

}  // namespace pointreel
