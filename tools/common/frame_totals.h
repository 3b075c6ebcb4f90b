// FrameStatistics of many frames in one.
#pragma once

#include "pointreel/codec.h"

namespace pointreel {

inline void add(FrameStatistics& sum, const FrameStatistics& frame) {
  sum.occupancy_bits += frame.occupancy_bits;
  sum.model_bits += frame.model_bits;
  sum.grid_bits += frame.grid_bits;
  sum.range_bits += frame.range_bits;
  sum.order_bits += frame.order_bits;
  sum.correction_bits += frame.correction_bits;
  sum.stray_bits += frame.stray_bits;
  sum.scattered_bits += frame.scattered_bits;
  sum.field_bits += frame.field_bits;
  sum.corrected_points += frame.corrected_points;
  sum.stray_points += frame.stray_points;
  sum.plane_bits += frame.plane_bits;
  sum.residual_bits += frame.residual_bits;
  sum.spatial_cells += frame.spatial_cells;
  sum.temporal_cells += frame.temporal_cells;
  sum.unfit_cells += frame.unfit_cells;
  sum.runs += frame.runs;
}

}  // namespace pointreel
