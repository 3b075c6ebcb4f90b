// What surrounds a cell, as far as the second stage of coding looks.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "predict/range_state.h"

namespace pointreel {

// Coded steps of a neighbour, as the context sees them: clipped to [-2, 2], plus 2.
inline std::uint8_t clipped_steps(std::int32_t steps) {
  return static_cast<std::uint8_t>((steps < -2 ? -2 : steps > 2 ? 2 : steps) + 2);
}
inline constexpr std::uint8_t kNoSteps = 2;

// 0 to 15: the sizes of the steps at five neighbours, by (((left, above, above right), left 2), above left)
// in base 5. The nearest two count twice.
inline constexpr auto kActivities = [] {
  std::array<std::uint8_t, 5 * 5 * 5 * 5 * 5> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto size = [i](std::size_t place) {
      const int steps = static_cast<int>(i / place % 5) - 2;
      return steps < 0 ? -steps : steps;
    };
    table[i] =
        static_cast<std::uint8_t>(std::min(15, 2 * (size(625) + size(125)) + size(25) + size(5) + size(1)));
  }
  return table;
}();

// Indices of adaptive models.
struct StepContext {
  std::size_t signs;         // of the steps left, above and above right
  std::size_t activity;      // 0 to 15
  std::size_t availability;  // of returns left and above
  std::size_t row;
  std::size_t error;  // 0 to 15: the blend's recent error

  // `here` and `above`: clipped steps at the cell and at the one above it.
  StepContext(const std::uint8_t* here, const std::uint8_t* above, bool has_left, bool has_above,
              int row_in_band, std::size_t blend_class)
      : signs((std::size_t{here[-1]} * 5 + above[0]) * 5 + above[1]),
        activity(kActivities[(signs * 5 + here[-2]) * 5 + above[-1]]),
        availability((has_left ? 1U : 0U) + (has_above ? 2U : 0U)),
        row(std::min(static_cast<std::size_t>(row_in_band), StepModels::kRows - 1)),
        error(std::clamp<std::size_t>(blend_class, 2, 17) - 2) {}
};

}  // namespace pointreel
