// A run's plane written as the ranges at up to three of its own occupied cells.
//
// Ranges at cells of the run are the natural coordinates of a plane here: one step of error at an anchor is
// about one step of error in the run, whatever the plane's slant, and neighbours predict them well.
// Coefficients of n would need a precision that depends on distance and incidence.
#pragma once

#include <array>
#include <cstdint>

#include "planes/plane_run.h"

namespace pointreel {

struct RunAnchors {
  int count = 0;                    // 1 for a single cell, 2 when all cells lie on a line of the grid
  std::array<GridCell, 3> cells{};  // grid rows
};

// Anchor ranges are at most this many steps, so that level arithmetic stays within 32 bits.
inline constexpr std::int32_t kMaxLevel = 1 << 28;

// Chosen from the occupancy alone, which the decoder knows: the leftmost and the rightmost cell (the lowest
// of their columns), and of the cells nearest to the middle in each row the one farthest from the line
// between them.
RunAnchors choose_anchors(const RangeImage& image, const TileLayout& layout, const PlaneRun& run);

// The plane through the anchors at levels * step_m.
Plane plane_from_anchors(const AngularGrid& grid, const RunAnchors& anchors,
                         const std::array<std::int32_t, 3>& levels, double step_m);

// Nearest level for a range, within [1, kMaxLevel].
std::int32_t nearest_level(double range_m, double step_m);

}  // namespace pointreel
