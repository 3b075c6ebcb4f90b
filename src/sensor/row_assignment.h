// Which row each point of a sweep belongs to, given the sensor model.
#pragma once

#include <cstdint>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/polar_points.h"
#include "sensor/sensor_model.h"

namespace pointreel {

inline constexpr std::int16_t kNoRow = -1;

// The laser-like integer field of a cloud (ring, channel, laser_id ...), nullptr when there is none.
const Field* find_ring_field(const PointCloud& cloud);
// Its values; empty when they are no integers within int32.
std::vector<std::int32_t> ring_values(const PointCloud& cloud);

// From the ring field when the model knows its rings, else from runs once around in one row, else from the
// nearest row. Points without a ray, and those whose ring is unknown, get kNoRow.
std::vector<std::int16_t> assign_rows(const SensorModel& model, const PointCloud& cloud,
                                      const PolarPoints& polar, int threads);

// By height alone: for clouds in no order, and while there are no rows yet. Points without a ray: kNoRow.
std::vector<std::int16_t> nearest_rows(const SensorModel& model, const PolarPoints& polar, int threads = 1);

// Moves points that miss their row by far to the nearest one, where no ring field tells: around the seam a
// run's ends may belong to its neighbours, and a cloud may have its seam elsewhere.
void settle_rows(const SensorModel& model, const PolarPoints& polar, int threads,
                 std::vector<std::int16_t>& rows);

// Distance of a point from the cone that row's laser sweeps, across the ray; positive above.
inline double height_above_row_m(const RowModel& row, double rho_m, double z_m) {
  return z_m - (row.slope * rho_m + row.offset_m);
}

}  // namespace pointreel
