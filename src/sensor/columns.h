// The columns of one sweep, and the column of each of its points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/raw_vector.h"
#include "sensor/polar_points.h"
#include "sensor/projection.h"
#include "sensor/sensor_model.h"

namespace pointreel {

struct SweepColumns {
  std::uint32_t ticks_per_turn = 0;
  std::vector<std::uint32_t> tick;          // as SweepGrid::column_tick
  RawVector<std::int32_t> column_of_point;  // -1: none near enough
};

// `azimuth_rad`: per point, the azimuth that its column must have (column_azimuths, or unwrapped along the
// firing order: up to two turns); rows[i] < 0: no such point.
SweepColumns find_columns(const SensorModel& model, const PolarPoints& polar,
                          const std::vector<std::int16_t>& rows, std::span<const float> azimuth_rad,
                          bool unwrapped, const GridOptions& options);

// Azimuth of the column that fires a row's laser at a point: alpha and h taken out, in [0, 2 pi).
RawVector<float> column_azimuths(const SensorModel& model, const PolarPoints& polar,
                                 const std::vector<std::int16_t>& rows, int threads);

}  // namespace pointreel
