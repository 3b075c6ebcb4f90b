// Temporal encoding (paper, section III-D): planes of the key frame tested in a predicted frame with their
// normal held and their distance c free. What does not hold is left for the spatial pass.
#pragma once

#include "planes/plane_run.h"
#include "planes/spatial.h"

namespace pointreel {

// Scaling a plane's distance scales every range on it by the same factor:
//   factor = 1 + shift * plane_step_m / farthest_m
// where farthest_m is the key plane's largest range over the run's cells, so that one step of shift is one
// step of range there.
Plane shifted_plane(const Plane& key_plane, std::int32_t shift, float farthest_m, double plane_step_m);

// The key plane's largest range over the occupied cells of the run's tiles; 0 when it misses one of them.
float farthest_on_plane(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                        const PlaneRun& run, const Plane& key_plane);

// As encode_tile_row_spatially, with `key_runs_of_tile` giving for each tile of the row the key frame's run
// there (or a negative mark).
void encode_tile_row_temporally(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                                int tile_row, const std::int32_t* tile_marks, const PlaneTolerance& tolerance,
                                const std::vector<PlaneRun>& key_runs, const std::int32_t* key_runs_of_tile,
                                std::vector<PlaneRun>& runs);

}  // namespace pointreel
