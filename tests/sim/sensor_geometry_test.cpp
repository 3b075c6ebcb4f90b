#include "sim/sensor_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pointreel::sim {
namespace {

constexpr double deg = std::numbers::pi / 180;

TEST(SensorGeometry, HdlHasTwoBlocksOf32LasersTopToBottom) {
  const SensorGeometry sensor = make_sensor_geometry(SensorKind::hdl_64e, 10);
  ASSERT_EQ(sensor.lasers.size(), 64u);
  EXPECT_NEAR(std::atan(sensor.lasers.front().slope()), 2 * deg, 0.15 * deg);
  EXPECT_NEAR(std::atan(sensor.lasers.back().slope()), -24.9 * deg, 0.25 * deg);
  for (std::size_t i = 1; i < 64; ++i) EXPECT_LT(sensor.lasers[i].slope(), sensor.lasers[i - 1].slope());
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(sensor.lasers[i].horizontal_offset_m(), i % 2 == 0 ? -0.026 : 0.026);
    EXPECT_NEAR(sensor.lasers[i].vertical_offset_m(), i < 32 ? 0.204 : 0.121, 0.0065);
    EXPECT_LT(std::abs(sensor.lasers[i].rotation_rad()), 11 * deg);
  }
}

TEST(SensorGeometry, VlpHas16LasersEveryTwoDegrees) {
  const SensorGeometry sensor = make_sensor_geometry(SensorKind::vlp_16, 10);
  ASSERT_EQ(sensor.lasers.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(std::atan(sensor.lasers[i].slope()), (15 - 2 * static_cast<double>(i)) * deg, 1e-12);
  }
  EXPECT_NEAR(sensor.lasers.front().vertical_offset_m(), -0.0112, 5e-5);  // the data sheet's corrections
  EXPECT_NEAR(sensor.lasers[12].vertical_offset_m(), 0.0066, 5e-5);
  EXPECT_NEAR(sensor.ticks_per_revolution / (sensor.firings_per_s / 10), 20, 1e-12);  // 0.2 deg
}

TEST(SensorGeometry, BeamsObeyTheRowModel) {
  for (const SensorKind kind : {SensorKind::hdl_64e, SensorKind::vlp_16}) {
    for (const Laser& laser : make_sensor_geometry(kind, 10).lasers) {
      const double angle_rad = 40 * deg;
      const Ray ray = laser.beam({std::cos(angle_rad), std::sin(angle_rad)});
      EXPECT_NEAR(ray.direction.norm(), 1, 1e-12);
      for (const double range_m : {2.0, 10.0, 80.0}) {
        const Eigen::Vector3d p = ray.origin_m + range_m * ray.direction;
        const double rho_m = std::hypot(p.x(), p.y());
        EXPECT_NEAR(p.z(), laser.slope() * rho_m + laser.vertical_offset_m(), 1e-4);
        EXPECT_NEAR(std::atan2(p.y(), p.x()),
                    angle_rad + laser.rotation_rad() + laser.horizontal_offset_m() / rho_m, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace pointreel::sim
