// The encoder's check of what the decoder will have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/corrections.h"
#include "pointreel/point_cloud.h"
#include "sensor/ray_table.h"

namespace pointreel {

// Verifies each point of the grid, in space and in float32. `range_of_cell_m`, `point_of_cell`: of the sensor
// grid; empty cells have range 0 and no point. `cells`: in output order.
std::vector<Correction> find_corrections(const RayTable& rays, const PointCloud& cloud,
                                         std::span<const float> range_of_cell_m,
                                         std::span<const std::uint32_t> point_of_cell,
                                         std::span<const std::uint32_t> cells, double max_error_m,
                                         int threads);

}  // namespace pointreel
