// The cells of a sweep, before they are predicted and coded.
#pragma once

#include <cstdint>
#include <span>

#include "pointreel/point_cloud.h"
#include "predict/coding_grid.h"
#include "predict/grid_image.h"
#include "predict/range_quantiser.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

struct SweepCells {
  RangeQuantiser quantiser;
  CodingGrid coding;
  GridImage image;  // as measured
};

// Takes points off the grid that float32 ranges and positions cannot hold within the bound.
void drop_unreachable(const PointCloud& cloud, double max_error_m, GriddedSweep& sweep);

// `range_of_cell_m`: see ranges_by_cell().
SweepCells cells_of_sweep(const SensorModel& model, const GriddedSweep& sweep,
                          std::span<const float> range_of_cell_m, double max_error_m, int threads);

}  // namespace pointreel
