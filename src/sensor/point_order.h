// The order of a sweep's points on its grid, and the points that break it.
#pragma once

#include <cstdint>
#include <vector>

#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Column at which each row starts when all start at the azimuth of seam_tick: what most start columns are.
std::vector<std::uint32_t> seam_columns(const SensorModel& model, const SweepGrid& grid);

// Sets grid.order and makes the few points that break it strays (out_of_order). Columns that were unwrapped
// along the sequence of the points (`in_firing_order`) allow column_major only.
void find_order(const SensorModel& model, bool in_firing_order, bool descending, GriddedSweep& sweep);

}  // namespace pointreel
