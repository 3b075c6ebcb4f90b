// What surrounds a cell, as far as the second stage of coding looks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "predict/range_state.h"

namespace pointreel {

// Coded steps of a neighbour, as the context sees them: clipped to [-2, 2].
inline std::int8_t clipped_steps(std::int32_t steps) {
  return static_cast<std::int8_t>(steps < -2 ? -2 : steps > 2 ? 2 : steps);
}

// Indices of adaptive models.
struct StepContext {
  std::size_t signs;         // of the steps left, above and above right
  std::size_t activity;      // 0 to 15: sizes of the steps at five neighbours
  std::size_t availability;  // of returns left and above
  std::size_t row;
  std::size_t error;  // 0 to 15: the blend's recent error

  // `here` and `above`: clipped steps at the cell and at the one above it.
  StepContext(const std::int8_t* here, const std::int8_t* above, bool has_left, bool has_above, int row_in_band,
              std::size_t blend_class)
      : signs(static_cast<std::size_t>(((here[-1] + 2) * 5 + above[0] + 2) * 5 + above[1] + 2)),
        activity(static_cast<std::size_t>(std::min(15, 2 * (std::abs(here[-1]) + std::abs(above[0])) + std::abs(above[1]) +
                                                           std::abs(here[-2]) + std::abs(above[-1])))),
        availability((has_left ? 1U : 0U) + (has_above ? 2U : 0U)),
        row(std::min(static_cast<std::size_t>(row_in_band), StepModels::kRows - 1)),
        error(std::clamp<std::size_t>(blend_class, 2, 17) - 2) {}
};

}  // namespace pointreel
