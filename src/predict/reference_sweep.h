// ReferenceSweep: what both sides keep of a decoded sweep to predict later ones from.
#pragma once

#include <span>
#include <vector>

#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Decoded points as the sensor measured them, before any motion compensation; in the layout of the sweep's
// coding image (coding_grid.h).
struct ReferenceSweep {
  int rows = 0;
  int columns = 0;
  std::vector<float> range_m;       // along the ray; 0: no return
  std::vector<float> x_m, y_m, z_m;  // in the sensor's coordinates; 0 where there is no return
  SweepGrid grid;
};

// `range_m`: of the coding image.
ReferenceSweep reference_from(const SensorModel& model, const SweepGrid& grid, std::span<const float> range_m,
                              int threads);

}  // namespace pointreel
