// PlaneTiles: which tiles of a sensor grid's image lie on planes, and on which.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "planes/plane_levels.h"

namespace pointreel {

// Blocks of cells; those at the lower and right border may be smaller. Wide and low: along a row surfaces go
// on for longer than across (docs/PLANES.md has other shapes).
inline constexpr int kTileRows = 2, kTileColumns = 8;

struct TileGrid {
  int rows = 0, columns = 0;  // of the image
  int down = 0, across = 0;   // tiles

  TileGrid() = default;
  TileGrid(int image_rows, int image_columns)
      : rows(image_rows),
        columns(image_columns),
        down((image_rows + kTileRows - 1) / kTileRows),
        across((image_columns + kTileColumns - 1) / kTileColumns) {}

  static int first_row(int tile_row) { return tile_row * kTileRows; }
  int end_row(int tile_row) const { return std::min(rows, (tile_row + 1) * kTileRows); }
  static int first_column(int tile) { return tile * kTileColumns; }
  int end_column(int tile) const { return std::min(columns, (tile + 1) * kTileColumns); }
  std::size_t index(int tile_row, int tile) const {
    return static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(across) +
           static_cast<std::size_t>(tile);
  }
  std::size_t count() const { return index(down, 0); }
};

// A plane on the grid: described at the tile where it comes first, in raster order.
struct TilePlane {
  // Normal from the plane of an earlier sweep: then only levels[0] counts.
  bool reused = false;
  std::uint8_t width = 0;  // it goes on for 2^width half tiles to either side
  PlaneLevels levels{};
  Plane plane;  // as decoded
};
inline constexpr int kExtentClasses = 8;

struct PlaneTiles {
  TileGrid tiles;
  std::vector<std::int32_t> plane_of_tile;  // -1: none
  std::vector<TilePlane> planes;            // in raster order of their first tiles
};

// Planes of the tiles around one, as far as they come before it; -1: none.
struct NeighbourPlanes {
  std::int32_t left, above, above_right, above_left;

  NeighbourPlanes(const PlaneTiles& planes, int tile_row, int tile) {
    const auto at = [&](int down, int right) {
      const bool inside = tile_row + down >= 0 && tile + right >= 0 && tile + right < planes.tiles.across;
      return inside ? planes.plane_of_tile[planes.tiles.index(tile_row + down, tile + right)] : -1;
    };
    left = at(0, -1);
    above = at(-1, 0);
    above_right = at(-1, 1);
    above_left = at(-1, -1);
  }
  // Those that may go on in the tile, each once; -1 for the others.
  std::array<std::int32_t, 3> distinct() const {
    return {left, above != left ? above : -1, above_right != left && above_right != above ? above_right : -1};
  }
};

// The frame at the middle of a tile.
PlaneFrame frame_of_tile(const SensorRays& rays, const TileGrid& tiles, int tile_row, int tile, int width);

// Ranges of all cells on planes, 0 for the others.
std::vector<float> ranges_on_planes_m(const SensorRays& rays, const PlaneTiles& planes, int threads);

}  // namespace pointreel
