// What the search for planes asks of a tile's eight columns at once.
#pragma once

#include <cstddef>
#include <span>

#include "planes/plane_tiles.h"
#include "planes/sensor_rays.h"

namespace pointreel {

// One row of an image, by column.
struct RowCells {
  const float *cosine, *sine;        // of the columns' azimuths
  const float *rho_m, *tolerance_m;  // tolerance where there is no return: kAnyTolerance
  const float* per_rho_m;            // 1 where there is none
};
inline constexpr float kAnyTolerance = 1e30F;
// Tests read as many cells beyond a tile's.
inline constexpr std::size_t kCellsBeyond = 8;

struct PlaneInRow {
  SensorRays::RowPlane plane;
  RowCells cells;
};

// Whether all returns of the tile that begins in `column` meet the plane within their tolerances.
bool tile_holds(std::span<const PlaneInRow> rows, std::size_t column);

// Whether no plane can: the tile's ranges bend more along a row than their tolerances explain. For planes
// from 1 m on, slopes of up to 0.5, side offsets of 5 cm and tolerances of half the range; beyond, some may.
bool tile_bends(std::span<const RowCells> rows, std::size_t column);

}  // namespace pointreel
