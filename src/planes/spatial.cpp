#include "planes/spatial.h"

#include <algorithm>

#include "planes/run_anchors.h"
#include "planes/tile_cells.h"

namespace pointreel {
namespace {

class RunGrower {
 public:
  RunGrower(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout, int tile_row,
            const PlaneTolerance& tolerance)
      : grid_(grid), image_(image), layout_(layout), tile_row_(tile_row), tolerance_(tolerance) {}

  PlaneMoments moments(int tile) const {
    PlaneMoments sums;
    all_cells(image_, layout_, tile_row_, tile, tile + 1, [&](int row, int column, float range_m) {
      const int grid_row = image_.first_row + row;
      const double cos_e = grid_.cos_elevation(grid_row);
      sums.add(cos_e * grid_.cos_azimuth(column), cos_e * grid_.sin_azimuth(column),
               grid_.sin_elevation(grid_row), range_m);
      return true;
    });
    return sums;
  }

  bool fits(const Plane& plane, int first_tile, int end_tile) const {
    return plane_holds(grid_, image_, layout_, tile_row_, first_tile, end_tile, plane,
                       tolerance_.threshold_m);
  }

  // Rounds the plane's anchor ranges; where the nearest levels break the threshold the seven other ways of
  // rounding are tried. False when none holds.
  bool quantise(const Plane& plane, PlaneRun& run) const {
    const RunAnchors anchors = choose_anchors(image_, layout_, run);
    std::array<std::int32_t, 3> nearest{}, other{};
    for (int i = 0; i < anchors.count; ++i) {
      const double range = plane_range(grid_, plane, anchors.cells[i].row, anchors.cells[i].column);
      nearest[i] = nearest_level(range, tolerance_.plane_step_m);
      other[i] = std::max(1, range > nearest[i] * tolerance_.plane_step_m ? nearest[i] + 1 : nearest[i] - 1);
    }
    for (int choice = 0; choice < 1 << anchors.count; ++choice) {
      for (int i = 0; i < anchors.count; ++i) run.levels[i] = (choice >> i) & 1 ? other[i] : nearest[i];
      run.plane = plane_from_anchors(grid_, anchors, run.levels, tolerance_.plane_step_m);
      if (fits(run.plane, run.first_tile, run.end_tile)) return true;
    }
    return false;
  }

 private:
  const AngularGrid& grid_;
  const RangeImage& image_;
  const TileLayout& layout_;
  int tile_row_;
  const PlaneTolerance& tolerance_;
};

}  // namespace

void encode_tile_row_spatially(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                               int tile_row, const std::int32_t* tile_marks, const PlaneTolerance& tolerance,
                               std::vector<PlaneRun>& runs) {
  const RunGrower grower(grid, image, layout, tile_row, tolerance);
  for (int tile = 0; tile < layout.tile_columns;) {
    if (tile_marks[tile] != kUnfitTile) {
      ++tile;
      continue;
    }
    PlaneMoments sums = grower.moments(tile);
    Plane plane = sums.fit();
    if (!grower.fits(plane, tile, tile + 1)) {
      ++tile;
      continue;
    }
    // Grow: keep the plane while it also holds the next tile, refit over all of the run when it does not.
    PlaneRun run;
    run.tile_row = tile_row;
    run.first_tile = tile;
    run.end_tile = tile + 1;
    std::vector<PlaneMoments> sums_by_tile = {sums};  // running sums, one per tile taken in
    std::vector<int> ends = {run.end_tile};
    for (int next = tile + 1; next < layout.tile_columns; ++next) {
      if (tile_marks[next] == kEmptyTile) continue;
      if (tile_marks[next] != kUnfitTile) break;  // already on another run
      PlaneMoments grown = sums_by_tile.back();
      grown += grower.moments(next);
      if (!grower.fits(plane, next, next + 1)) {
        const Plane refitted = grown.fit();
        if (!grower.fits(refitted, run.first_tile, next + 1)) break;
        plane = refitted;
      }
      run.end_tile = next + 1;
      sums_by_tile.push_back(grown);
      ends.push_back(run.end_tile);
    }
    // The plane as the decoder will have it: quantised, over the longest part of the run that it still holds.
    bool holds = false;
    while (!ends.empty() && !holds) {
      run.end_tile = ends.back();
      holds = grower.quantise(sums_by_tile.back().fit(), run) || grower.quantise(plane, run);
      ends.pop_back();
      sums_by_tile.pop_back();
    }
    if (holds) {
      runs.push_back(run);
      tile = run.end_tile;
    } else {
      ++tile;
    }
  }
}

}  // namespace pointreel
