// A few points of each row of a projected sweep, as they lie about the rows of a model.
#pragma once

#include <cstddef>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

struct RowSample {
  double rho_m = 0;
  double range_m = 0;   // along the ray
  double height_m = 0;  // above the row's cone
  double turn_rad = 0;  // from the column's azimuth
};
using RowSamples = std::vector<std::vector<RowSample>>;  // per row

// Every so many rows, from `first` on (which is less).
struct RowsInTurn {
  std::size_t first = 0, step = 1;
};

// The sweep may have been projected with another model of the same rows. Rows that it is not the turn of have
// no samples.
RowSamples take_row_samples(const SensorModel& model, const PointCloud& cloud, const GriddedSweep& sweep,
                            const RowsInTurn& turn = {});

}  // namespace pointreel
