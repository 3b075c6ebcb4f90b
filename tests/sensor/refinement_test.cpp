// What more sweeps add to a model, and the lattice of its ranges.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "sensor/projection.h"
#include "sensor/ray_table.h"
#include "sensor/sensor_estimator.h"
#include "sim/sensor_geometry.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

TEST(Refinement, MendsARowThatTheFirstSweepHardlySaw) {
  constexpr std::size_t kThinRow = 9;
  const auto sweeps = simulated_drive(5);
  const sim::SensorGeometry truth = sim::make_sensor_geometry(SensorKind::vlp_16, 10);
  SensorEstimator whole;
  whole.add(sweeps[0].cloud);
  ASSERT_TRUE(whole.model());
  const GriddedSweep grid = project(*whole.model(), sweeps[0].cloud);
  PointCloud thinned;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < sweeps[0].cloud.size(); ++i) {
    const bool thin = grid.cell_of_point[i] >= 0 &&
                      static_cast<std::size_t>(grid.cell_of_point[i]) / grid.grid.column_count() == kThinRow;
    if (!thin || seen++ % 60 == 0) thinned.positions.push_back(sweeps[0].cloud.positions[i]);
  }
  SensorEstimator estimator;
  estimator.add(thinned);
  ASSERT_TRUE(estimator.model());
  const SensorModel first = *estimator.model();
  ASSERT_EQ(first.rows.size(), truth.lasers.size());
  for (std::size_t k = 1; k < sweeps.size(); ++k) estimator.add(sweeps[k].cloud);
  const SensorModel& refined = *estimator.model();
  ASSERT_EQ(refined.rows.size(), first.rows.size());
  EXPECT_EQ(refined.row_sequence, first.row_sequence);
  EXPECT_EQ(refined.ticks_per_turn, first.ticks_per_turn);
  for (std::size_t r = 0; r < refined.rows.size(); ++r) {
    EXPECT_NEAR(refined.rows[r].slope, truth.lasers[r].slope(), 2e-5);
    EXPECT_NEAR(refined.rows[r].offset_m, truth.lasers[r].vertical_offset_m(), 5e-4);
    EXPECT_NEAR(refined.rows[r].side_offset_m, truth.lasers[r].horizontal_offset_m(), 1e-3);
  }
}

TEST(Refinement, TakesASweepProjectedBefore) {
  const auto sweeps = simulated_drive(2);
  SensorEstimator alone;
  SensorEstimator helped;
  alone.add(sweeps[0].cloud);
  helped.add(sweeps[0].cloud);
  ASSERT_TRUE(alone.model());
  const GriddedSweep grid = project(*helped.model(), sweeps[1].cloud);
  alone.add(sweeps[1].cloud);
  helped.refine(sweeps[1].cloud, grid);
  EXPECT_EQ(*alone.model(), *helped.model());
}

// With two turns each sweep teaches every other row: but for the second one, whose model is the first that
// heeds what the first sweep said of all rows. In the end all rows are as well known as after as many sweeps
// for each.
TEST(Refinement, TakesTurns) {
  const auto sweeps = simulated_drive(16);
  SensorEstimator estimator({}, 2);
  estimator.add(sweeps[0].cloud);
  ASSERT_TRUE(estimator.model());
  estimator.add(sweeps[1].cloud);
  const SensorModel second = *estimator.model();
  estimator.add(sweeps[2].cloud);
  const SensorModel third = *estimator.model();
  estimator.add(sweeps[3].cloud);
  const SensorModel fourth = *estimator.model();
  std::size_t changed = 0;
  for (std::size_t r = 0; r < second.rows.size(); ++r) {
    changed += third.rows[r] == second.rows[r] ? 0 : 1;
    changed += fourth.rows[r] == third.rows[r] ? 0 : 1;
    const auto& [earlier, later] = r % 2 == 0 ? std::tie(second, third) : std::tie(third, fourth);
    EXPECT_EQ(later.rows[r], earlier.rows[r]) << r;
  }
  EXPECT_GT(changed, second.rows.size() / 2);
  for (std::size_t k = 4; k < 15; ++k) estimator.add(sweeps[k].cloud);
  const SensorModel last = *estimator.model();
  const sim::SensorGeometry truth = sim::make_sensor_geometry(SensorKind::vlp_16, 10);
  for (std::size_t r = 0; r < last.rows.size(); ++r) {
    EXPECT_NEAR(last.rows[r].slope, truth.lasers[r].slope(), 2e-5);
    EXPECT_NEAR(last.rows[r].offset_m, truth.lasers[r].vertical_offset_m(), 5e-4);
  }
  estimator.add(sweeps[15].cloud);
  EXPECT_EQ(*estimator.model(), last);
}

TEST(RangeLattice, IsFoundWhereThereIsOne) {
  const PointCloud cloud = simulated_drive(1)[0].cloud;
  SensorEstimator estimator;
  estimator.add(cloud);
  ASSERT_TRUE(estimator.model());
  const SensorModel& model = *estimator.model();
  ASSERT_DOUBLE_EQ(model.range_step_m, 0.002);
  ASSERT_EQ(model.range_phase.size(), model.rows.size());
  const GriddedSweep sweep = project(model, cloud);
  std::size_t near = 0;
  std::size_t placed = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    const std::size_t row = static_cast<std::size_t>(sweep.cell_of_point[i]) / sweep.grid.column_count();
    const double steps = static_cast<double>(sweep.range_m[i]) / model.range_step_m - model.range_phase[row];
    ++placed;
    near += std::fabs(steps - std::nearbyint(steps)) * model.range_step_m < 8e-4 ? 1 : 0;
  }
  EXPECT_GT(near * 100, placed * 99);
}

TEST(RangeLattice, IsNotSeenInNoise) {
  PointCloud cloud = simulated_drive(1)[0].cloud;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> stretched(1, 1.01F);
  for (Point3f& p : cloud.positions) {
    const float k = stretched(random);
    p = {k * p.x, k * p.y, k * p.z};
  }
  SensorEstimator estimator;
  estimator.add(cloud);
  ASSERT_TRUE(estimator.model());
  EXPECT_EQ(estimator.model()->range_step_m, 0);
  EXPECT_TRUE(estimator.model()->range_phase.empty());
}

TEST(RayTable, WholeRowsAreTheSameBitsAsSinglePoints) {
  SensorModel model;
  model.ticks_per_turn = 4000;
  model.rows = {rounded({0.1, 0.2, 3.1, 0.026}), rounded({-0.4, 0.1, -3, -0.026}), rounded({0, 0, 0, 0})};
  SweepGrid grid;
  grid.ticks_per_turn = 4000;
  for (std::uint32_t c = 0; c < 4000; c += 3) grid.column_tick.push_back(c);
  std::vector<float> ranges_m(grid.column_count());
  for (std::size_t c = 0; c < ranges_m.size(); ++c) ranges_m[c] = static_cast<float>(c % 97) * 0.8F - 1;
  std::vector<Point3f> points(ranges_m.size());
  for (const double scale : {0.0, 0.05, 8.0}) {
    grid.motion.reset();
    if (scale > 0) grid.motion = Twist{{scale, -scale, 0.01}, {0.01, 0.1 * scale, scale}};
    const RayTable rays(model, grid);
    for (std::size_t r = 0; r < model.rows.size(); ++r) {
      rays.positions_of_row(r, ranges_m, points);
      for (std::size_t c = 0; c < points.size(); ++c)
        ASSERT_EQ(points[c], rays.position(r, c, ranges_m[c])) << r << ' ' << c;
    }
  }
}

}  // namespace
}  // namespace pointreel
