// The model of a simulated sensor against the truth, from clouds in every order.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "grid_checks.h"
#include "sensor/sensor_estimator.h"
#include "sim/sensor_geometry.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

enum class Order {
  plain,
  half_turn,
  shuffled,
  sparse,
  columns,
  columns_back,
  columns_staggered,  // each row some columns late
  rows_from_firing,   // all rows begin at one firing, so at azimuths of their own
};

struct Scene {
  SensorKind sensor;
  Order order;
  bool rings;
};

void PrintTo(const Scene& scene, std::ostream* stream) {
  *stream << (scene.sensor == SensorKind::hdl_64e ? "HDL-64E" : "VLP-16") << " order "
          << static_cast<int>(scene.order) << (scene.rings ? " with rings" : "");
}

PointCloud subset(const PointCloud& cloud, const std::vector<std::size_t>& points,
                  const std::vector<std::uint16_t>& rings) {
  PointCloud taken;
  std::vector<std::uint16_t> ring;
  for (const std::size_t i : points) {
    taken.positions.push_back(cloud.positions[i]);
    if (!rings.empty()) ring.push_back(rings[i]);
  }
  if (!rings.empty()) taken.fields.push_back({"ring", std::move(ring)});
  return taken;
}

class SimulatedSensors : public testing::TestWithParam<Scene> {
 protected:
  // The sweep in the order asked for. Rows and columns are taken from the plain sweep's own grid.
  static PointCloud sweep(const Scene& scene) {
    SimulatorOptions options;
    options.sensor = scene.sensor;
    Simulator simulator(options);
    for (int i = 0; i < 8; ++i) simulator.next_sweep();
    const PointCloud cloud = simulator.next_sweep().cloud;
    SensorEstimator estimator;
    estimator.add(cloud);
    EXPECT_TRUE(estimator.model());
    const GriddedSweep grid = project(*estimator.model(), cloud);
    const std::size_t columns = grid.grid.column_count();
    const std::size_t rows = estimator.model()->rows.size();
    std::vector<std::size_t> points;
    std::vector<std::uint16_t> rings(scene.rings ? cloud.size() : 0);
    std::vector<std::size_t> key(cloud.size()), staggered(cloud.size()), by_row(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (grid.cell_of_point[i] < 0) continue;
      const std::size_t row = static_cast<std::size_t>(grid.cell_of_point[i]) / columns;
      const std::size_t column = static_cast<std::size_t>(grid.cell_of_point[i]) % columns;
      points.push_back(i);
      if (scene.rings) rings[i] = static_cast<std::uint16_t>(rows - 1 - row);
      key[i] = column * rows + row * 7 % rows;  // lasers do not fire top to bottom
      staggered[i] = (column + row * 5 % 6) * rows + row * 7 % rows;
      by_row[i] = row * columns + column;
    }
    std::mt19937 random(5);
    const auto by_column = [&](std::size_t a, std::size_t b) { return key[a] < key[b]; };
    switch (scene.order) {
      case Order::plain:
      case Order::half_turn:
        break;
      case Order::shuffled:
        std::shuffle(points.begin(), points.end(), random);
        break;
      case Order::sparse:
        std::erase_if(points, [&](std::size_t) { return random() % 3 != 0; });
        break;
      case Order::columns:
        std::sort(points.begin(), points.end(), by_column);
        break;
      case Order::columns_back:
        std::sort(points.rbegin(), points.rend(), by_column);
        break;
      case Order::columns_staggered:
        std::sort(points.begin(), points.end(),
                  [&](std::size_t a, std::size_t b) { return staggered[a] < staggered[b]; });
        break;
      case Order::rows_from_firing:
        std::sort(points.begin(), points.end(),
                  [&](std::size_t a, std::size_t b) { return by_row[a] < by_row[b]; });
        break;
    }
    PointCloud taken = subset(cloud, points, rings);
    // Rows then start behind the sensor.
    if (scene.order == Order::half_turn) {
      for (Point3f& p : taken.positions) p = {-p.x, -p.y, p.z};
    }
    return taken;
  }
};

TEST_P(SimulatedSensors, AreRecovered) {
  const Scene scene = GetParam();
  const PointCloud cloud = sweep(scene);
  SensorEstimator estimator;
  estimator.add(cloud);
  ASSERT_TRUE(estimator.model());
  const SensorModel& model = *estimator.model();
  const sim::SensorGeometry truth = sim::make_sensor_geometry(scene.sensor, 10);
  ASSERT_EQ(model.rows.size(), truth.lasers.size());
  // Or as many as are ever used.
  ASSERT_GT(model.ticks_per_turn, 0u);
  EXPECT_EQ(static_cast<std::uint32_t>(truth.ticks_per_revolution) % model.ticks_per_turn, 0u);
  EXPECT_EQ(model.ring_of_row.empty(), !scene.rings);
  for (std::size_t r = 0; r < model.rows.size(); ++r) {
    EXPECT_NEAR(model.rows[r].slope, truth.lasers[r].slope(), 1e-4);
    EXPECT_NEAR(model.rows[r].offset_m, truth.lasers[r].vertical_offset_m(), 1e-3);
    EXPECT_NEAR(model.rows[r].side_offset_m, truth.lasers[r].horizontal_offset_m(), 2e-3);
  }

  const GriddedSweep grid = project(model, cloud);
  check_grid(model, cloud, grid);
  const SensorDiagnosis diagnosis = diagnose(model, std::span(&grid, 1));
  EXPECT_LT(diagnosis.deviation.p95_m, 1e-3);
  EXPECT_GT(count_of(diagnosis, StrayReason::none) * 1000, cloud.size() * 998);
  const bool columns = scene.order == Order::columns || scene.order == Order::columns_back ||
                       scene.order == Order::columns_staggered;
  if (scene.order == Order::shuffled) {
    EXPECT_EQ(grid.grid.order.kind, OrderKind::none);
  } else if (columns) {
    EXPECT_EQ(grid.grid.order.kind, OrderKind::column_major);
    EXPECT_EQ(grid.grid.order.descending, scene.order == Order::columns_back);
  } else {
    EXPECT_NE(grid.grid.order.kind, OrderKind::none);
    EXPECT_NE(grid.grid.order.kind, OrderKind::column_major);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedSensors,
                         testing::Values(Scene{SensorKind::hdl_64e, Order::plain, false},
                                         Scene{SensorKind::hdl_64e, Order::half_turn, false},
                                         Scene{SensorKind::hdl_64e, Order::shuffled, false},
                                         Scene{SensorKind::hdl_64e, Order::sparse, false},
                                         Scene{SensorKind::hdl_64e, Order::columns, true},
                                         Scene{SensorKind::hdl_64e, Order::columns_staggered, true},
                                         Scene{SensorKind::hdl_64e, Order::columns_staggered, false},
                                         Scene{SensorKind::hdl_64e, Order::rows_from_firing, true},
                                         Scene{SensorKind::vlp_16, Order::plain, true},
                                         Scene{SensorKind::vlp_16, Order::half_turn, false},
                                         Scene{SensorKind::vlp_16, Order::shuffled, false},
                                         Scene{SensorKind::vlp_16, Order::sparse, false},
                                         Scene{SensorKind::vlp_16, Order::columns, false},
                                         Scene{SensorKind::vlp_16, Order::columns_back, true},
                                         Scene{SensorKind::vlp_16, Order::columns_staggered, false}));

TEST(SimulatedSensors, OneModelServesAllSweepsOnAnyNumberOfThreads) {
  const auto sweeps = simulated_drive(3, SensorKind::hdl_64e);
  SensorEstimator estimator;
  estimator.add(sweeps[0].cloud);
  ASSERT_TRUE(estimator.model());
  for (const SimulatedSweep& sweep : sweeps) {
    GridOptions options;
    const GriddedSweep one = project(*estimator.model(), sweep.cloud, options);
    check_grid(*estimator.model(), sweep.cloud, one);
    options.threads = 3;
    const GriddedSweep three = project(*estimator.model(), sweep.cloud, options);
    EXPECT_EQ(one.cell_of_point, three.cell_of_point);
    EXPECT_EQ(one.range_m, three.range_m);
    EXPECT_EQ(one.grid, three.grid);
  }
}

}  // namespace
}  // namespace pointreel
