#include "planes/plane_tiles.h"

#include <cmath>

#include "base/parallel.h"
#include "base/trigonometry.h"

namespace pointreel {

PlaneFrame frame_of_tile(const SensorRays& rays, const TileGrid& tiles, int tile_row, int tile, int width) {
  const int first_row = TileGrid::first_row(tile_row), last_row = tiles.end_row(tile_row) - 1;
  const int row = (first_row + last_row) / 2;
  const int column = (TileGrid::first_column(tile) + tiles.end_column(tile) - 1) / 2;
  const double half_tile_rad = kPi * kTileColumns / rays.columns();
  constexpr double kLeastHalfHeight = 1e-3;  // of a tile of one row
  const double half_tile_height =
      std::fabs(rays.row(first_row).slope - rays.row(last_row).slope) / 2 + kLeastHalfHeight;
  return {rays.direction(row, column), half_tile_rad * (1 << width), half_tile_height};
}

std::vector<float> ranges_on_planes_m(const SensorRays& rays, const PlaneTiles& planes, int threads) {
  const TileGrid& tiles = planes.tiles;
  const auto columns = static_cast<std::size_t>(tiles.columns);
  std::vector<float> range_m(columns * static_cast<std::size_t>(tiles.rows));
  parallel_for(static_cast<std::size_t>(tiles.down), threads, [&](std::size_t piece) {
    const int tile_row = static_cast<int>(piece);
    const std::int32_t* plane_of_tile = &planes.plane_of_tile[tiles.index(tile_row, 0)];
    for (int first = 0, end = 0; first < tiles.across; first = end) {
      const std::int32_t plane = plane_of_tile[first];
      for (end = first + 1; end < tiles.across && plane_of_tile[end] == plane;) ++end;
      if (plane < 0) continue;
      const int first_column = TileGrid::first_column(first);
      const auto count = static_cast<std::size_t>(tiles.end_column(end - 1) - first_column);
      for (int row = TileGrid::first_row(tile_row); row < tiles.end_row(tile_row); ++row) {
        const std::size_t at =
            static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(first_column);
        rays.plane_ranges_m(planes.planes[static_cast<std::size_t>(plane)].plane, row, first_column,
                            std::span(range_m).subspan(at, count));
      }
    }
  });
  return range_m;
}

}  // namespace pointreel
