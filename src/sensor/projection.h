// project: a cloud into the cells of the sensor's own grid.
#pragma once

#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

struct GridOptions {
  double max_deviation_m = 0.05;  // points farther than this from every ray are strays
  // Columns on no lattice: their azimuths are sent in steps that move the points by a fraction of this.
  double max_error_m = 0.02;
  int threads = 1;
};

// Every point that is no stray has a cell of its own, and cells_in_order() of those cells gives these points
// in the order of the cloud, but for few (unless the order is none). Any cloud will do; one that does not fit
// becomes strays. `previous`: the grid of the sweep before, if known; it saves time where this one is much
// alike. The order is then taken from it where it can be: settle_order() checks that.
GriddedSweep project(const SensorModel& model, const PointCloud& cloud, const GridOptions& options = {},
                     const SweepGrid* previous = nullptr);

}  // namespace pointreel
