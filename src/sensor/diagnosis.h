// SensorDiagnosis: how well a sensor model fits its sweeps, for people.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

struct DeviationPercentiles {
  double p50_m = 0, p95_m = 0, p99_m = 0, max_m = 0;
};

struct SensorDiagnosis {
  std::size_t rows = 0;
  double lowest_elevation_rad = 0, highest_elevation_rad = 0;
  double lowest_offset_m = 0, highest_offset_m = 0;
  double largest_side_offset_m = 0;  // by magnitude
  std::uint32_t ticks_per_turn = 0;  // 0: no lattice
  bool has_rings = false, motion_compensated = false;
  double mean_columns = 0;  // per sweep
  double occupancy = 0;     // points on the grid over cells
  std::size_t points = 0;
  std::array<std::size_t, 6> points_by_reason{};  // indexed by StrayReason; [none]: on the grid
  DeviationPercentiles deviation;
};

SensorDiagnosis diagnose(const SensorModel& model, std::span<const GriddedSweep> sweeps);

}  // namespace pointreel
