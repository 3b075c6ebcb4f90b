// ReferenceSweep: what both sides keep of a decoded sweep to predict later ones from.
#pragma once

#include <span>
#include <vector>

#include "predict/band_coding.h"
#include "predict/grid_image.h"
#include "predict/reference_image.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Decoded points as the sensor measured them, before any motion compensation; in the layout of the sweep's
// coding image (coding_grid.h).
struct ReferenceSweep {
  int rows = 0;
  int columns = 0;
  std::vector<float> range_m;        // along the ray; 0: no return
  std::vector<float> x_m, y_m, z_m;  // in the sensor's coordinates; 0 where there is no return
  SweepGrid grid;
  // What coding it has taught, where it was itself predicted: the next sweep goes on from there.
  std::vector<BandState> states;
};

// Draws the decoded ranges of a predicted sweep towards what the sweeps before it say, as far as both show
// the same surface: noise and rounding average out over the sweeps. `step_m`: the quantiser's.
void draw_together(const ReferenceImage& warped, float step_m, GridImage& decoded);

// `range_m`: of the coding image. `states`: at the end of its bands; empty where it was coded by itself.
ReferenceSweep reference_from(const SensorModel& model, const SweepGrid& grid, std::span<const float> range_m,
                              std::vector<BandState> states, int threads);

}  // namespace pointreel
