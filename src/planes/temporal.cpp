#include "planes/temporal.h"

#include <algorithm>
#include <cmath>

#include "planes/run_anchors.h"
#include "planes/tile_cells.h"

namespace pointreel {
namespace {

// A range on a plane that can be scaled: in front of the sensor and not near the plane's horizon.
bool usable(double range_m) {
  return range_m > 0 && range_m < 1e6;
}

// What a set of cells says about the factor by which the key plane's ranges must be scaled.
struct ScaleRequirement {
  double lowest = 0, highest = 1e9;    // every factor in between keeps all cells within the threshold
  double sum_r_rk = 0, sum_rk_rk = 0;  // least squares: factor = sum r r_key / sum r_key^2
  double farthest_m = 0;

  void merge(const ScaleRequirement& other) {
    lowest = std::max(lowest, other.lowest);
    highest = std::min(highest, other.highest);
    sum_r_rk += other.sum_r_rk;
    sum_rk_rk += other.sum_rk_rk;
    farthest_m = std::max(farthest_m, other.farthest_m);
  }

  // The shift nearest to the least-squares factor that keeps every cell, if any.
  bool best_shift(double plane_step_m, std::int32_t& shift) const {
    if (!(lowest <= highest)) return false;
    const double shifts_per_factor = farthest_m / plane_step_m;
    const double low = std::ceil((lowest - 1) * shifts_per_factor);
    const double high = std::floor((highest - 1) * shifts_per_factor);
    if (!(low <= high) || std::fabs(low) > kMaxLevel || std::fabs(high) > kMaxLevel) return false;
    const double wanted = std::floor((sum_r_rk / sum_rk_rk - 1) * shifts_per_factor + 0.5);
    shift = static_cast<std::int32_t>(std::clamp(wanted, low, high));
    return true;
  }
};

ScaleRequirement scale_requirement(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                                   int tile_row, int tile, const Plane& key_plane, float threshold_m) {
  ScaleRequirement need;
  const bool met =
      all_cells(image, layout, tile_row, tile, tile + 1, [&](int row, int column, float range_m) {
        const double range = range_m;
        const double on_key = plane_range(grid, key_plane, image.first_row + row, column);
        if (!usable(on_key)) return false;
        need.lowest = std::max(need.lowest, (range - threshold_m) / on_key);
        need.highest = std::min(need.highest, (range + threshold_m) / on_key);
        need.sum_r_rk += range * on_key;
        need.sum_rk_rk += on_key * on_key;
        need.farthest_m = std::max(need.farthest_m, on_key);
        return true;
      });
  if (!met) need.highest = -1;
  return need;
}

}  // namespace

Plane shifted_plane(const Plane& key_plane, std::int32_t shift, float farthest_m, double plane_step_m) {
  const double factor = 1.0 + shift * plane_step_m / farthest_m;
  return {key_plane.x / factor, key_plane.y / factor, key_plane.z / factor};
}

float farthest_on_plane(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                        const PlaneRun& run, const Plane& key_plane) {
  float farthest = 0;
  const bool met =
      all_cells(image, layout, run.tile_row, run.first_tile, run.end_tile, [&](int row, int column, float) {
        const float range = plane_range(grid, key_plane, image.first_row + row, column);
        farthest = std::max(farthest, range);
        return usable(range);
      });
  return met ? farthest : 0;
}

void encode_tile_row_temporally(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                                int tile_row, const std::int32_t* tile_marks, const PlaneTolerance& tolerance,
                                const std::vector<PlaneRun>& key_runs, const std::int32_t* key_runs_of_tile,
                                std::vector<PlaneRun>& runs) {
  // The interval test runs in double and the decoder in float; the margin covers the difference, the exact
  // test below catches what it does not.
  const float margin_threshold_m = tolerance.threshold_m * 0.9999f;
  for (int tile = 0; tile < layout.tile_columns;) {
    const std::int32_t key_run = key_runs_of_tile[tile];
    if (tile_marks[tile] != kUnfitTile || key_run < 0) {
      ++tile;
      continue;
    }
    const Plane& key_plane = key_runs[static_cast<std::size_t>(key_run)].plane;
    PlaneRun run;
    run.kind = RunKind::temporal;
    run.tile_row = tile_row;
    run.first_tile = tile;
    run.end_tile = tile;
    run.key_run = key_run;
    ScaleRequirement total;
    for (int next = tile; next < layout.tile_columns; ++next) {
      if (tile_marks[next] == kEmptyTile) continue;
      if (tile_marks[next] != kUnfitTile || key_runs_of_tile[next] != key_run) break;
      ScaleRequirement grown = total;
      grown.merge(scale_requirement(grid, image, layout, tile_row, next, key_plane, margin_threshold_m));
      std::int32_t shift = 0;
      if (!grown.best_shift(tolerance.plane_step_m, shift)) break;
      total = grown;
      run.levels[0] = shift;
      run.end_tile = next + 1;
    }
    if (run.end_tile > tile) {
      const float farthest_m = farthest_on_plane(grid, image, layout, run, key_plane);
      run.plane = shifted_plane(key_plane, run.levels[0], farthest_m, tolerance.plane_step_m);
      if (plane_holds(grid, image, layout, tile_row, run.first_tile, run.end_tile, run.plane,
                      tolerance.threshold_m)) {
        runs.push_back(run);
        tile = run.end_tile;
        continue;
      }
    }
    ++tile;
  }
}

}  // namespace pointreel
