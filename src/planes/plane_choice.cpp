#include "planes/plane_choice.h"

#include <cmath>
#include <utility>
#include <vector>

namespace pointreel {
namespace {

// What is known of the points on a plane.
struct Evidence {
  int points = 0;
  int bends = 0;      // neighbours in a row, three at a time
  double bend_m = 0;  // the sum of their second differences' sizes
};

std::vector<Evidence> gather(std::span<const float> range_m, const PlaneTiles& planes) {
  std::vector<Evidence> evidence(planes.planes.size());
  const TileGrid& tiles = planes.tiles;
  const auto columns = static_cast<std::size_t>(tiles.columns);
  for (int tile_row = 0; tile_row < tiles.down; ++tile_row) {
    for (int tile = 0; tile < tiles.across; ++tile) {
      const std::int32_t plane = planes.plane_of_tile[tiles.index(tile_row, tile)];
      if (plane < 0) continue;
      Evidence& sum = evidence[static_cast<std::size_t>(plane)];
      for (int row = TileGrid::first_row(tile_row); row < tiles.end_row(tile_row); ++row) {
        const float* at = &range_m[static_cast<std::size_t>(row) * columns];
        for (int c = TileGrid::first_column(tile); c < tiles.end_column(tile); ++c) {
          if (!(at[c] > 0)) continue;
          ++sum.points;
          if (c < TileGrid::first_column(tile) + 2 || !(at[c - 1] > 0) || !(at[c - 2] > 0)) continue;
          ++sum.bends;
          sum.bend_m += std::fabs(static_cast<double>(at[c] - 2 * at[c - 1] + at[c - 2]));
        }
      }
    }
  }
  return evidence;
}

// Of one range by the mixture, given how far its neighbours scatter: fitted to drives 0001 and 0005.
double bits_per_point(const Evidence& evidence, double range_step_m) {
  constexpr double kScatterPerBend = 0.51;  // of normally distributed noise: sqrt(pi / 12)
  const double scatter_m = evidence.bends > 0 ? kScatterPerBend * evidence.bend_m / evidence.bends : 0;
  return 0.1 + std::log2(1 + 4 * scatter_m / range_step_m);
}

}  // namespace

void drop_dear_planes(std::span<const float> range_m, double range_step_m, PlaneTiles& planes) {
  constexpr double kBitsPerPlane = 24, kBitsPerReuse = 8;  // with those of their tiles' labels
  const auto evidence = gather(range_m, planes);
  std::vector<std::int32_t> now(planes.planes.size(), -1);
  std::vector<TilePlane> kept;
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    const double cost = planes.planes[i].reused ? kBitsPerReuse : kBitsPerPlane;
    if (evidence[i].points * bits_per_point(evidence[i], range_step_m) < cost) continue;
    now[i] = static_cast<std::int32_t>(kept.size());
    kept.push_back(planes.planes[i]);
  }
  planes.planes = std::move(kept);
  for (std::int32_t& plane : planes.plane_of_tile) {
    if (plane >= 0) plane = now[static_cast<std::size_t>(plane)];
  }
}

}  // namespace pointreel
