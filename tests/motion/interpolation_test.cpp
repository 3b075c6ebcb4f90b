#include <gtest/gtest.h>

#include "pointreel/motion.h"

namespace pointreel {
namespace {

TimedPose turned(double time_s, double x_m, double yaw_rad) {
  TimedPose pose;
  pose.time_s = time_s;
  pose.T_world_sensor.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.T_world_sensor.translation().x() = x_m;
  return pose;
}

TEST(InterpolatePose, IsLinearInTimeBetweenNeighbours) {
  const std::vector<TimedPose> track{turned(1, 0, 0), turned(2, 10, 0.4), turned(4, 10, 0.4)};
  EXPECT_TRUE(interpolate_pose(track, 1.25).isApprox(turned(0, 2.5, 0.1).T_world_sensor, 1e-12));
  EXPECT_TRUE(interpolate_pose(track, 2).isApprox(track[1].T_world_sensor, 1e-12));
  EXPECT_TRUE(interpolate_pose(track, 3).isApprox(track[1].T_world_sensor, 1e-12));
}

TEST(InterpolatePose, TurnsTheShortWay) {
  const std::vector<TimedPose> track{turned(0, 0, 3), turned(1, 0, -3)};
  EXPECT_TRUE(interpolate_pose(track, 0.5).isApprox(turned(0, 0, M_PI).T_world_sensor, 1e-12));
}

TEST(InterpolatePose, IsClampedToTheEnds) {
  const std::vector<TimedPose> track{turned(1, 3, 0.3), turned(2, 4, 0.4)};
  EXPECT_TRUE(interpolate_pose(track, -5).isApprox(track[0].T_world_sensor));
  EXPECT_TRUE(interpolate_pose(track, 99).isApprox(track[1].T_world_sensor));
  EXPECT_TRUE(interpolate_pose(std::span(track).first(1), 99).isApprox(track[0].T_world_sensor));
}

}  // namespace
}  // namespace pointreel
