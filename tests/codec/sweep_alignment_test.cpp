#include "codec/sweep_alignment.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/sensor_estimator.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

// Of a sensor that turns counterclockwise.
std::vector<PointCloud> sweeps_at_speed(int count) {
  Simulator simulator = simulator_at_speed(SensorKind::vlp_16);
  std::vector<PointCloud> sweeps;
  for (int i = 0; i < count; ++i) sweeps.push_back(simulator.next_sweep().cloud);
  return sweeps;
}

// What travels with each; every fifth is a key.
std::vector<std::optional<SweepMotion>> motions(SweepAlignment alignment,
                                                const std::vector<PointCloud>& sweeps,
                                                const std::optional<Pose>& T_world_sensor) {
  SensorEstimator estimator;
  std::vector<std::optional<SweepMotion>> motions;
  for (const PointCloud& sweep : sweeps) {
    if (!estimator.model()) estimator.add(sweep);
    const GriddedSweep gridded = project(*estimator.model(), sweep);
    motions.push_back(alignment.follow(*estimator.model(), gridded.grid, ranges_by_cell(gridded),
                                       T_world_sensor, motions.size() % 5 == 0));
  }
  return motions;
}

TEST(SweepAlignment, LearnsWhichWayTheSensorTurnsOnTheWay) {
  const auto found = motions(SweepAlignment(true), sweeps_at_speed(15), std::nullopt);
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i].has_value(), i % 5 != 0) << i;
  // Each goes by what the sweeps before it have taught, across groups.
  EXPECT_EQ(found[1]->per_turn, 0);
  EXPECT_GT(found.back()->per_turn, 0.4);
  EXPECT_NEAR(found[6]->per_turn, found.back()->per_turn, 0.5);
}

TEST(SweepAlignment, TakesGivenPosesAsTheyAre) {
  const auto found = motions(SweepAlignment(false), sweeps_at_speed(3), Pose::Identity());
  ASSERT_TRUE(found[1] && found[2]);
  EXPECT_TRUE(found[2]->T_ref_cur.isApprox(Pose::Identity()));
  EXPECT_EQ(found[2]->per_turn, 0);
}

}  // namespace
}  // namespace pointreel
