// The error budget of a sweep: how coarse its ranges may be, given how far the points lie from their rays.
#pragma once

#include <vector>

#include "predict/range_quantiser.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// The quantiser with the fewest bits by estimate: coarser ranges save bits in every point, but those that
// then miss the bound need a correction each.
RangeQuantiser choose_quantiser(const SensorModel& model, const GriddedSweep& sweep, double max_error_m);

// Per row, where the sensor's lattice of ranges has a point; empty for a model without one.
std::vector<float> lattice_phases_m(const SensorModel& model);

}  // namespace pointreel
