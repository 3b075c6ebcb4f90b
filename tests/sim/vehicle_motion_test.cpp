#include "sim/vehicle_motion.h"

#include <gtest/gtest.h>

namespace pointreel::sim {
namespace {

using Eigen::Vector3d;

class VehicleMotionTest : public testing::Test {
 protected:
  Road road_{11};
  VehicleMotion motion_{road_, 8, 12};
};

TEST_F(VehicleMotionTest, RestsUntilTimeZeroThenReachesCruisingSpeed) {
  const VehicleState rest = motion_.state(-0.5);
  EXPECT_TRUE(rest.T_world_sensor.isApprox(motion_.state(0).T_world_sensor, 0));
  EXPECT_EQ(rest.acceleration_world_mps2, Vector3d::Zero());
  EXPECT_EQ(rest.rotation_rate_sensor_radps, Vector3d::Zero());
  EXPECT_NEAR((motion_.road_position_m(120) - motion_.road_position_m(20)) / 100, 8, 0.3);
}

TEST_F(VehicleMotionTest, AccelerationIsTheSecondDerivativeOfPosition) {
  constexpr double h = 1e-3;
  for (double t = 0.01; t < 30; t += 0.37) {
    const auto at = [&](double time_s) -> Vector3d {
      return motion_.state(time_s).T_world_sensor.translation();
    };
    const Vector3d numeric = (at(t + h) - 2 * at(t) + at(t - h)) / (h * h);
    EXPECT_LT((numeric - motion_.state(t).acceleration_world_mps2).norm(), 1e-4) << "at " << t << " s";
  }
}

TEST_F(VehicleMotionTest, RotationRateIsTheDerivativeOfAttitude) {
  constexpr double h = 1e-4;
  for (double t = 0.01; t < 30; t += 0.37) {
    const Eigen::Matrix3d before = motion_.state(t - h).T_world_sensor.linear();
    const Eigen::AngleAxisd turn(before.transpose() * motion_.state(t + h).T_world_sensor.linear());
    const Vector3d numeric = turn.angle() * turn.axis() / (2 * h);
    EXPECT_LT((numeric - motion_.state(t).rotation_rate_sensor_radps).norm(), 1e-6) << "at " << t << " s";
  }
}

TEST_F(VehicleMotionTest, MovesLikeACar) {
  for (double t = 0; t < 300; t += 0.05) {
    const VehicleState state = motion_.state(t);
    EXPECT_LT(state.acceleration_world_mps2.norm(), 4);
    EXPECT_LT(state.rotation_rate_sensor_radps.norm(), 0.2);
    EXPECT_NEAR(state.T_world_sensor.translation().z(), 1.73, 0.02);
    EXPECT_GT(state.T_world_sensor.linear()(2, 2), 0.9998);  // tilted by about 1 deg at most
  }
}

TEST(VehicleMotion, StandsStillAtCruisingSpeedZero) {
  const Road road(1);
  const VehicleMotion motion(road, 0, 2);
  EXPECT_TRUE(motion.state(50).T_world_sensor.isApprox(motion.state(0).T_world_sensor, 0));
}

}  // namespace
}  // namespace pointreel::sim
