// Walking the cells of tiles, and the test that both plane passes rest on.
#pragma once

#include <cmath>

#include "planes/plane_run.h"

namespace pointreel {

// Calls visit(row, column, range_m) for the occupied cells of tiles [first_tile, end_tile) in raster order,
// until it returns false. Returns whether all of them returned true.
template <class Visit>
bool all_cells(const RangeImage& image, const TileLayout& layout, int tile_row, int first_tile, int end_tile,
               const Visit& visit) {
  const int column_begin = layout.first_column(first_tile);
  const int column_end = layout.end_column(end_tile - 1, image.columns);
  for (int row = layout.first_row(tile_row); row < layout.end_row(tile_row); ++row) {
    for (int column = column_begin; column < column_end; ++column) {
      const float range_m = image.at(row, column);
      if (range_m > 0 && !visit(row, column, range_m)) return false;
    }
  }
  return true;
}

inline bool tile_occupied(const RangeImage& image, const TileLayout& layout, int tile_row, int tile) {
  return !all_cells(image, layout, tile_row, tile, tile + 1, [](int, int, float) { return false; });
}

// Every cell within the threshold and in front of the sensor: nearer than the threshold, a plane behind the
// ray would be within it, too, but decodes to no range.
inline bool plane_holds(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                        int tile_row, int first_tile, int end_tile, const Plane& plane, float threshold_m) {
  return all_cells(image, layout, tile_row, first_tile, end_tile, [&](int row, int column, float range_m) {
    const float on_plane_m = plane_range(grid, plane, image.first_row + row, column);
    return on_plane_m > 0 && std::fabs(on_plane_m - range_m) <= threshold_m;
  });
}

}  // namespace pointreel
