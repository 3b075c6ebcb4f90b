#include "codec/sweep_cells.h"

#include <algorithm>
#include <cmath>

#include "base/simd_loops.h"
#include "codec/corrections.h"
#include "codec/error_budget.h"

namespace pointreel {
namespace {

// Those of its points from one on, one after the other.
const float* coordinates_of(const PointCloud& cloud, std::size_t first) {
  static_assert(sizeof(Point3f) == 3 * sizeof(float));
  return &cloud.positions[first].x;
}

POINTREEL_SIMD_LOOPS void drop_beyond(const PointCloud& cloud, float reach_m, GriddedSweep& sweep) {
  constexpr float kNearestM = 0.01F;
  // Hardly a block has one.
  constexpr std::size_t kBlock = 64;
  for (std::size_t first = 0; first < cloud.size(); first += kBlock) {
    const std::size_t count = std::min(cloud.size() - first, kBlock);
    const float* coordinates_m = coordinates_of(cloud, first);
    const float* ranges_m = &sweep.range_m[first];
    int any = 0;
    for (std::size_t k = 0; k < 3 * count; ++k) any |= std::fabs(coordinates_m[k]) < reach_m ? 0 : 1;
    for (std::size_t i = 0; i < count; ++i)
      any |= (ranges_m[i] < reach_m ? 0 : 1) | (ranges_m[i] > kNearestM ? 0 : 1);
    if (any == 0) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const float* p = coordinates_m + 3 * i;
      const float farthest_m = std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2]), ranges_m[i]});
      std::int32_t& cell = sweep.cell_of_point[first + i];
      if (cell < 0 || (farthest_m < reach_m && ranges_m[i] > kNearestM)) continue;
      sweep.point_of_cell[static_cast<std::size_t>(cell)] = kNoPoint;
      cell = -1;
    }
  }
}

}  // namespace

void drop_unreachable(const PointCloud& cloud, double max_error_m, GriddedSweep& sweep) {
  drop_beyond(cloud,
              static_cast<float>(std::min(CorrectionSteps(max_error_m).reach_m(),
                                          max_error_m * static_cast<double>(kMostRangeSteps) / 16)),
              sweep);
}

SweepCells cells_of_sweep(const SensorModel& model, const GriddedSweep& sweep,
                          std::span<const float> range_of_cell_m, double max_error_m, int threads) {
  SweepCells cells{choose_quantiser(model, sweep, max_error_m), CodingGrid(model, sweep.grid), {}};
  cells.image = cells.coding.image_of(range_of_cell_m, threads);
  return cells;
}

}  // namespace pointreel
