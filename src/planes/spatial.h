// Spatial encoding (paper, section III-C): planes fitted to tiles and grown to the right while they hold.
#pragma once

#include "planes/plane_run.h"

namespace pointreel {

struct PlaneTolerance {
  float threshold_m =
      0.1f;  // |range on the decoded plane - range of the cell| for every cell of a plane tile
  double plane_step_m = 0.05;  // quantisation of the anchor ranges
};

// Appends the runs of one row of tiles to `runs`. Only tiles marked kUnfitTile in `tile_marks` (one mark per
// tile of the row) are considered; tiles that end up on a run are left to the caller to mark. Rows are
// independent, so that threads can share a frame.
void encode_tile_row_spatially(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                               int tile_row, const std::int32_t* tile_marks, const PlaneTolerance& tolerance,
                               std::vector<PlaneRun>& runs);

}  // namespace pointreel
