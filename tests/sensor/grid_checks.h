// What every projected sweep must keep, and its way through the bytes of the stream.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sensor/diagnosis.h"
#include "sensor/order_moves.h"
#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/ray_table.h"
#include "sensor/sensor_coding.h"

namespace pointreel {

inline std::size_t count_of(const SensorDiagnosis& diagnosis, StrayReason reason) {
  return diagnosis.points_by_reason[static_cast<std::size_t>(reason)];
}

inline void check_grid(const SensorModel& model, const PointCloud& cloud, const GriddedSweep& sweep) {
  ASSERT_EQ(sweep.cell_of_point.size(), cloud.size());
  ASSERT_EQ(sweep.range_m.size(), cloud.size());
  ASSERT_EQ(sweep.deviation_m.size(), cloud.size());
  const std::size_t columns = sweep.grid.column_count();
  const std::size_t cells = model.rows.size() * columns;
  ASSERT_LE(cells, kMaxCells);
  std::vector<std::uint8_t> occupied(cells, 0);
  std::vector<float> ranges_m(cells, 0);
  const RayTable rays(model, sweep.grid);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_EQ(sweep.cell_of_point[i] < 0, sweep.stray_reason[i] != StrayReason::none);
    if (sweep.cell_of_point[i] < 0) continue;
    const auto cell = static_cast<std::size_t>(sweep.cell_of_point[i]);
    ASSERT_LT(cell, cells);
    ASSERT_EQ(occupied[cell], 0) << "two points in a cell";
    occupied[cell] = 1;
    ranges_m[cell] = sweep.range_m[i];
    const Point3f p = rays.position(cell / columns, cell % columns, sweep.range_m[i]);
    const Point3f& q = cloud.positions[i];
    const double away = std::hypot(static_cast<double>(p.x) - static_cast<double>(q.x),
                                   static_cast<double>(p.y) - static_cast<double>(q.y),
                                   static_cast<double>(p.z) - static_cast<double>(q.z));
    const double rounding_m = 2e-6 * std::hypot(static_cast<double>(q.x), static_cast<double>(q.y)) + 5e-4;
    ASSERT_NEAR(away, static_cast<double>(sweep.deviation_m[i]), rounding_m) << "point " << i;
  }
  // The points come back in their order.
  if (sweep.grid.order.kind != OrderKind::none) {
    const auto expected = cells_in_order(occupied, ranges_m, model, sweep.grid);
    const auto actual = cells_of_points(sweep);
    ASSERT_EQ(expected.size(), actual.size());
    const auto moves = find_moves(expected, actual, cells);
    EXPECT_LE(moves.size(), actual.size() / 50 + 2);
    const auto decoded = decode_moves(expected.size(), encode_moves(moves));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(apply_moves(expected, *decoded), actual);
  }
  const auto grid = decode_sweep_grid(model, encode_sweep_grid(model, sweep.grid));
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(*grid, sweep.grid);
  const auto decoded_model = decode_sensor_model(encode_sensor_model(model));
  ASSERT_TRUE(decoded_model) << decoded_model.error().message;
  EXPECT_EQ(*decoded_model, model);
}

}  // namespace pointreel
