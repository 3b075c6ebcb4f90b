// The encoder's check of what the decoder will have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/corrections.h"
#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Verifies each point of the grid, in space and in float32. `range_of_cell_m`: as decoded; empty cells have
// range 0. `cells`: in output order.
std::vector<Correction> find_corrections(const SensorModel& model, const PointCloud& cloud,
                                         const GriddedSweep& sweep, std::span<const float> range_of_cell_m,
                                         std::span<const std::uint32_t> cells, double max_error_m,
                                         int threads);

}  // namespace pointreel
