// What the search for planes asks of a tile's eight columns at once.
#pragma once

#include <cstddef>
#include <span>

#include "planes/plane_tiles.h"
#include "planes/sensor_rays.h"

namespace pointreel {

// One row of an image, by column.
struct RowCells {
  const float *rho_m, *tolerance_m;  // tolerance where there is no return: kAnyTolerance
  const float* per_rho_m;            // 1 where there is none
};
inline constexpr float kAnyTolerance = 1e30F;
// Tests read as many cells beyond a tile's.
inline constexpr std::size_t kCellsBeyond = 8;

struct PlaneInRow {
  SensorRays::RowPlane plane;
  const float *cosine, *sine;
  RowCells cells;
};

// Whether all returns of the tile that begins in `column` meet the plane within their tolerances.
bool tile_holds(std::span<const PlaneInRow> rows, std::size_t column);

// Whether its ranges bend more along a row than those of any plane within their tolerances. `curvature`: by
// what a sine is off a line over a tile, of itself.
bool tile_bends(std::span<const RowCells> rows, std::size_t column, float curvature);

}  // namespace pointreel
