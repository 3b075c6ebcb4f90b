// What the plane passes produce: runs of tiles, each on one plane (the paper's triples start, length, plane).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "planes/angular_grid.h"
#include "planes/plane_fit.h"
#include "planes/range_image.h"

namespace pointreel {

// Square blocks of cells over a range image; the last column of tiles may be narrower.
struct TileLayout {
  int tile_size = 4;
  int tile_rows = 0;
  int tile_columns = 0;

  TileLayout() = default;
  TileLayout(const RangeImage& image, int size)
      : tile_size(size), tile_rows(image.rows / size), tile_columns((image.columns + size - 1) / size) {}

  int first_row(int tile_row) const { return tile_row * tile_size; }
  int end_row(int tile_row) const { return (tile_row + 1) * tile_size; }
  int first_column(int tile_column) const { return tile_column * tile_size; }
  int end_column(int tile_column, int columns) const {
    return std::min((tile_column + 1) * tile_size, columns);
  }
  std::size_t index(int tile_row, int tile_column) const {
    return static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(tile_columns) +
           static_cast<std::size_t>(tile_column);
  }
  std::size_t count() const { return index(tile_rows, 0); }
};

enum class RunKind : std::uint8_t {
  spatial,   // its own plane, by the ranges at up to three anchor cells
  temporal,  // a plane of the key frame with the same normal and a new distance
};

struct PlaneRun {
  RunKind kind = RunKind::spatial;
  int tile_row = 0;
  int first_tile = 0;
  int end_tile = 0;  // one past the last; empty tiles inside belong to the run
  // spatial: range at each anchor in units of the plane step. temporal: [0] = distance shift (see
  // temporal.h).
  std::array<std::int32_t, 3> levels{};
  int key_run = -1;  // temporal: index of the key frame's run
  Plane plane;       // as decoded
};

// Marks in PlaneMap::run_of_tile besides run numbers.
inline constexpr std::int32_t kUnfitTile = -1;
inline constexpr std::int32_t kEmptyTile = -2;

struct PlaneMap {
  TileLayout layout;
  std::vector<PlaneRun> runs;  // in raster order of their first tiles
  std::vector<std::int32_t>
      run_of_tile;  // run number, kUnfitTile or kEmptyTile; empty tiles in a run: kEmptyTile
};

// Range at which the ray of a cell meets the plane, in float, exactly as encoder and decoder both use it; not
// positive when the plane is behind the ray.
inline float plane_range(const AngularGrid& grid, const Plane& plane, int grid_row, int column) {
  const float across = static_cast<float>(plane.x) * grid.cos_azimuth(column) +
                       static_cast<float>(plane.y) * grid.sin_azimuth(column);
  return 1.0f /
         (grid.cos_elevation(grid_row) * across + static_cast<float>(plane.z) * grid.sin_elevation(grid_row));
}

}  // namespace pointreel
