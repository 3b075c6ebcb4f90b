// The encoder's ticks, seen in the azimuths of the points.
#pragma once

#include <cstdint>
#include <vector>

#include "sensor/polar_points.h"

namespace pointreel {

using RowPoints = std::vector<std::vector<std::uint32_t>>;  // for each row, indices of its points

// Ticks per turn that the azimuths of every row are multiples of, up to a phase of the row; 0: none.
std::uint32_t find_ticks_per_turn(const PolarPoints& polar, const RowPoints& rows);

struct RowAzimuth {
  double side_offset_m = 0;
  double phase_rad = 0;  // alpha, up to whole ticks
  double sharpness = 0;  // 1: every point on a tick, 0: anywhere
};

// The side offset that puts the row's points on ticks, and their phase.
RowAzimuth fit_row_azimuth(const PolarPoints& polar, const std::vector<std::uint32_t>& points,
                           std::uint32_t ticks_per_turn);

// Whole ticks by which each row is ahead of the others, from the pattern of the ticks in use: one of all
// rows' patterns agree. ticks[row]: the row's ticks in [0, ticks_per_turn), phase taken out.
// No row is moved by more than most_ticks.
std::vector<std::int32_t> align_rows(const std::vector<std::vector<std::uint32_t>>& ticks,
                                     std::uint32_t ticks_per_turn, std::uint32_t most_ticks);

}  // namespace pointreel
