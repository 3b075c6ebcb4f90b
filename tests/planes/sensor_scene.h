// A small sensor with all that real ones have, and the ranges at which its rays meet a plane.
#pragma once

#include <cmath>
#include <vector>

#include "planes/sensor_rays.h"
#include "sensor/ray_table.h"

namespace pointreel {

struct SensorScene {
  SensorModel model;
  SweepGrid grid;
  std::vector<std::size_t> shifts;

  explicit SensorScene(int rows = 11, int columns = 250) {
    for (int r = 0; r < rows; ++r) {
      model.rows.push_back(rounded(
          {0.1 - 0.03 * r, r % 2 == 0 ? 0.2 : 0.12, 0.05 * (r % 3) - 0.04, r % 2 == 0 ? 0.026 : -0.026}));
    }
    model.ticks_per_turn = 1000;
    grid.ticks_per_turn = 1000;
    for (int c = 0; c < columns; ++c) grid.column_tick.push_back(static_cast<std::uint32_t>(3 * c + c % 2));
    for (const std::int32_t shift : column_shift_of_row(model, grid))
      shifts.push_back(static_cast<std::size_t>((shift % columns + columns) % columns));
  }
  SensorRays rays() const { return {model, grid, shifts}; }

  // As a decoder places a point, in the sensor's coordinates.
  Point3f point(int row, int image_column, float range_m) const {
    const std::size_t columns = grid.column_count();
    const auto column =
        (static_cast<std::size_t>(image_column) + columns - shifts[static_cast<std::size_t>(row)]) % columns;
    return RayTable(model, grid).measured_position(static_cast<std::size_t>(row), column, range_m);
  }
};

inline double off_plane(const Plane& plane, const Point3f& p) {
  const double length = std::sqrt(plane.x * plane.x + plane.y * plane.y + plane.z * plane.z);
  return std::fabs((plane.x * static_cast<double>(p.x) + plane.y * static_cast<double>(p.y) +
                    plane.z * static_cast<double>(p.z) - 1) /
                   length);
}

// n of the plane normal . p = distance_m.
inline Plane plane_of(double x, double y, double z, double distance_m) {
  const double scale = 1 / (std::sqrt(x * x + y * y + z * z) * distance_m);
  return {x * scale, y * scale, z * scale};
}

}  // namespace pointreel
