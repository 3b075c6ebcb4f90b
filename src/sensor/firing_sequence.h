// Firing sequence: in which order the lasers of a column-major cloud fire.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pointreel {

// In which sequence the points of a column come, and by how many columns each row's come late.
struct FiringSequence {
  std::vector<std::uint16_t> rows;   // a permutation
  std::vector<std::uint16_t> delay;  // per row; empty: none is late
};

// fired_column: of each point, ascending with time; negative: none.
FiringSequence find_firing_sequence(const std::vector<std::int16_t>& rows,
                                    std::span<const std::int32_t> fired_column, std::size_t row_count);

}  // namespace pointreel
