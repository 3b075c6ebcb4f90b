#include "sim/ground.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pointreel::sim {
namespace {

class GroundTest : public testing::Test {
 protected:
  double height_beside(double x_m, double lateral_m) const {
    const Eigen::Vector2d p = road_.beside(x_m, lateral_m);
    return ground_.height_m(p.x(), p.y());
  }

  Road road_{41};
  Ground ground_{road_, {{20, 30}}, -100, 100};
};

TEST_F(GroundTest, HasCrownCurbAndCrossing) {
  EXPECT_NEAR(height_beside(5, 0), 0.05, 0.001);
  EXPECT_NEAR(height_beside(5, curb_lateral_m - 0.2), 0, 0.005);
  EXPECT_NEAR(height_beside(5, -curb_lateral_m - 0.2), 0.12, 0.005);
  EXPECT_NEAR(height_beside(25, curb_lateral_m + 1), 0, 1e-9);
}

TEST_F(GroundTest, BeamsEndOnTheSurface) {
  const Eigen::Vector3d sensor_m(0, road_.y_m(0.0) - lane_centre_m, 1.9);
  for (double azimuth_rad = -3; azimuth_rad < 3.2; azimuth_rad += 0.01) {
    for (const double slope : {-0.03, -0.1, -0.4}) {
      const Ray ray{sensor_m,
                    Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), slope).normalized()};
      const auto hit = ground_.cast(ray, 120);
      ASSERT_TRUE(hit);
      const Eigen::Vector3d p = sensor_m + hit->range_m * ray.direction;
      EXPECT_NEAR(p.z(), ground_.height_m(p.x(), p.y()), 3e-4);
    }
  }
}

TEST_F(GroundTest, BeamsAboveTheHorizonMissIt) {
  EXPECT_FALSE(ground_.cast({{0, 0, 1.9}, {1, 0, 0}}, 120));
  EXPECT_FALSE(ground_.cast({{0, 0, 1.9}, Eigen::Vector3d(1, 0, -0.01).normalized()}, 120));
}

}  // namespace
}  // namespace pointreel::sim
