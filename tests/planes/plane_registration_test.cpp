#include <gtest/gtest.h>

#include <numbers>

#include "pointreel/planes.h"

namespace pointreel {
namespace {

struct Wall {
  Eigen::Vector3d normal;  // of unit length
  double distance_m;
};

// Tiles of the walls as a sensor at this pose would have them: where they are nearest in their direction.
SweepPlanes seen_from(const std::vector<Wall>& walls, const Pose& T_world_sensor, std::uint32_t frame) {
  SweepPlanes sweep;
  sweep.frame = frame;
  const Pose T_sensor_world = T_world_sensor.inverse();
  for (const Wall& wall : walls) {
    SweepPlane plane;
    plane.normal = T_sensor_world.linear() * wall.normal;
    plane.distance_m = wall.distance_m - wall.normal.dot(T_world_sensor.translation());
    if (plane.distance_m < 0) {
      plane.normal = -plane.normal;
      plane.distance_m = -plane.distance_m;
    }
    sweep.planes.push_back(plane);
  }
  for (std::uint32_t row = 0; row < 32; ++row) {
    for (std::uint32_t column = 0; column < 270; ++column) {
      const double azimuth_rad = 2 * std::numbers::pi * column / 270, slope = 0.1 - 0.015 * row;
      const Eigen::Vector3d ray(std::cos(azimuth_rad), std::sin(azimuth_rad), slope);
      double nearest = 50;
      PlaneTile tile;
      for (std::uint32_t p = 0; p < sweep.planes.size(); ++p) {
        const double rho_m = sweep.planes[p].distance_m / sweep.planes[p].normal.dot(ray);
        if (!(rho_m > 1 && rho_m < nearest)) continue;
        nearest = rho_m;
        tile = {p, 2 * row, 8 * column, 16, (rho_m * ray).cast<float>()};
      }
      if (nearest < 50) sweep.tiles.push_back(tile);
    }
  }
  return sweep;
}

std::vector<Wall> street() {
  return {{Eigen::Vector3d(0, 0, -1), 1.8}, {Eigen::Vector3d(0, 1, 0), 6}, {Eigen::Vector3d(0, -1, 0), 5}};
}
std::vector<Wall> yard() {
  auto walls = street();
  walls.push_back({Eigen::Vector3d(1, 0, 0), 20});
  walls.push_back({Eigen::Vector3d(-1, 0.2, 0).normalized(), 15});
  return walls;
}

Pose moved(double forward_m, double left_m, double yaw_rad) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() << forward_m, left_m, 0.02;
  return pose;
}

TEST(RegisterPlanes, FindTheMotion) {
  const SweepPlanes reference = seen_from(yard(), Pose::Identity(), 0);
  for (const Pose& motion : {moved(0, 0, 0), moved(0.8, 0.1, 0.02), moved(-0.5, -0.2, -0.05)}) {
    const auto found = register_planes(reference, seen_from(yard(), motion, 1));
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT((found->T_ref_cur.translation() - motion.translation()).norm(), 1e-3);
    EXPECT_LT(Eigen::AngleAxisd(found->T_ref_cur.linear().transpose() * motion.linear()).angle(), 1e-4);
    EXPECT_GT(found->inlier_share, 0.9);
  }
}

TEST(RegisterPlanes, SayWhatTheyCannotTell) {
  const Pose motion = moved(0.8, 0.1, 0.02);
  for (const auto& walls : {street(), std::vector<Wall>{street()[0]}}) {
    const auto found = register_planes(seen_from(walls, Pose::Identity(), 3), seen_from(walls, motion, 4));
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(found.error().message, "too few planes constrain the motion from frame 3 to 4");
  }
  EXPECT_FALSE(register_planes({}, {}));
  EXPECT_FALSE(register_planes(seen_from(yard(), Pose::Identity(), 0), {}));
}

}  // namespace
}  // namespace pointreel
