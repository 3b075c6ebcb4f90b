// A few points of each row of a projected sweep, as they lie about the rows of a model.
#pragma once

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

// The sweep may have been projected with another model of the same rows.
RowSamples take_row_samples(const SensorModel& model, const PointCloud& cloud, const GriddedSweep& sweep);

}  // namespace pointreel
