#include "pointreel/simulator.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/sensor_geometry.h"

namespace pointreel {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

double azimuth_rad(const Point3f& p) {
  const double azimuth = std::atan2(double{p.y}, double{p.x});
  return azimuth < 0 ? azimuth + two_pi : azimuth;
}

// A new row starts where the azimuth drops by more than 1 rad.
std::vector<std::size_t> split_rows(const PointCloud& cloud) {
  std::vector<std::size_t> row_of_point(cloud.size());
  for (std::size_t i = 1; i < cloud.size(); ++i) {
    const bool starts = azimuth_rad(cloud.positions[i]) < azimuth_rad(cloud.positions[i - 1]) - 1;
    row_of_point[i] = row_of_point[i - 1] + (starts ? 1 : 0);
  }
  return row_of_point;
}

const std::vector<float>& intensity(const SimulatedSweep& sweep) {
  return std::get<std::vector<float>>(sweep.cloud.find_field("intensity")->values);
}

std::uint64_t hash(const SimulatedSweep& sweep) {
  const auto& positions = sweep.cloud.positions;
  const std::uint64_t h = XXH3_64bits(positions.data(), positions.size() * sizeof(Point3f));
  return XXH3_64bits_withSeed(intensity(sweep).data(), intensity(sweep).size() * sizeof(float), h);
}

TEST(Simulator, ParsesSensorNames) {
  EXPECT_EQ(*parse_sensor_kind("hdl-64e"), SensorKind::hdl_64e);
  EXPECT_EQ(*parse_sensor_kind("vlp-16"), SensorKind::vlp_16);
  const auto unknown = parse_sensor_kind("hdl-32");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::invalid_argument);
}

TEST(Simulator, ValidatesOptions) {
  EXPECT_TRUE(validate({}));
  EXPECT_FALSE(validate({.sweep_rate_hz = 0}));
  EXPECT_FALSE(validate({.sweep_rate_hz = std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(validate({.cruise_speed_mps = -1}));
  EXPECT_FALSE(validate({.range_noise_m = -0.1}));
  EXPECT_FALSE(validate({.drop_out = 1.5}));
}

TEST(Simulator, SameSeedSameBytesOtherSeedOtherBytes) {
  Simulator a({.seed = 5}), b({.seed = 5}), c({.seed = 6});
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t h = hash(a.next_sweep());
    EXPECT_EQ(h, hash(b.next_sweep()));
    EXPECT_NE(h, hash(c.next_sweep()));
  }
}

// Points of a sweep obey the sensor's row model to the rounding of its coordinates.
void check_geometry(const SimulatedSweep& sweep, const sim::SensorGeometry& sensor) {
  const PointCloud& cloud = sweep.cloud;
  const std::vector<std::size_t> row_of_point = split_rows(cloud);
  ASSERT_EQ(row_of_point.back() + 1, sensor.lasers.size());
  const double tick_rad = two_pi / sensor.ticks_per_revolution;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3f& p = cloud.positions[i];
    const sim::Laser& laser = sensor.lasers[row_of_point[i]];
    const double rho_m = std::hypot(double{p.x}, double{p.y});
    ASSERT_NEAR(p.z, laser.slope() * rho_m + laser.vertical_offset_m(), 0.001) << "point " << i;
    const double tick =
        (azimuth_rad(p) - laser.rotation_rad() - laser.horizontal_offset_m() / rho_m) / tick_rad;
    ASSERT_LT(std::abs(tick - std::round(tick)) * tick_rad * rho_m, 0.001) << "point " << i;
    if (i > 0 && row_of_point[i] == row_of_point[i - 1]) {
      ASSERT_GE(azimuth_rad(p), azimuth_rad(cloud.positions[i - 1]));
    }
    ASSERT_FLOAT_EQ(p.x, static_cast<float>(std::round(double{p.x} * 1000) / 1000));
    ASSERT_GE(intensity(sweep)[i], 0);
    ASSERT_LE(intensity(sweep)[i], 0.99f);
  }
}

TEST(Simulator, HdlSweepsAreLikeKittis) {
  const sim::SensorGeometry sensor = sim::make_sensor_geometry(SensorKind::hdl_64e, 10);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Simulator simulator({.seed = seed});
    for (int i = 0; i < 4; ++i) {
      const SimulatedSweep sweep = simulator.next_sweep();
      EXPECT_DOUBLE_EQ(sweep.time_s, 0.1 * i);
      EXPECT_EQ(intensity(sweep).size(), sweep.cloud.size());
      EXPECT_GT(sweep.cloud.size(), 112'000u);
      EXPECT_LT(sweep.cloud.size(), 127'000u);
      if (i == 3) check_geometry(sweep, sensor);
    }
  }
}

TEST(Simulator, VlpSweepsObeyTheSensorModel) {
  Simulator simulator({.sensor = SensorKind::vlp_16});
  const SimulatedSweep sweep = simulator.next_sweep();
  EXPECT_GT(sweep.cloud.size(), 15'000u);
  EXPECT_LT(sweep.cloud.size(), 16u * 1800u);
  check_geometry(sweep, sim::make_sensor_geometry(SensorKind::vlp_16, 10));
}

TEST(Simulator, RangesLieOnTheLattice) {
  Simulator simulator({});
  const SimulatedSweep sweep = simulator.next_sweep();
  const sim::SensorGeometry sensor = sim::make_sensor_geometry(SensorKind::hdl_64e, 10);
  const std::vector<std::size_t> row_of_point = split_rows(sweep.cloud);
  double squares = 0;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const Point3f& p = sweep.cloud.positions[i];
    const sim::Laser& laser = sensor.lasers[row_of_point[i]];
    const double h_m = laser.horizontal_offset_m();
    const double along_m = std::sqrt(double{p.x} * p.x + double{p.y} * p.y - h_m * h_m);
    const double range_m = std::hypot(along_m, p.z - laser.vertical_offset_m());
    const double off_m = range_m - 0.002 * std::round(range_m / 0.002);
    squares += off_m * off_m;
  }
  // Rounding to millimetres leaves 0.29 mm; ranges off the lattice would give 0.58 mm.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(sweep.cloud.size())), 0.00036);
}

TEST(Simulator, DropOutsTakeTheirShare) {
  Simulator full({.drop_out = 0}), half({.drop_out = 0.5});
  const auto points = static_cast<double>(full.next_sweep().cloud.size());
  EXPECT_NEAR(static_cast<double>(half.next_sweep().cloud.size()) / points, 0.5, 0.01);
}

TEST(Simulator, PosesMoveSmoothlyAndTheImuCoversThem) {
  Simulator simulator({.sensor = SensorKind::vlp_16});
  Pose before = Pose::Identity();
  constexpr int sweeps = 60;
  for (int i = 0; i < sweeps; ++i) {
    const Pose pose = simulator.next_sweep().T_world_sensor;
    if (i > 0) {
      const Pose step = before.inverse() * pose;
      EXPECT_LT(step.translation().norm(), 1.1);
      EXPECT_LT(Eigen::AngleAxisd(step.linear()).angle(), 0.03);
    }
    before = pose;
  }
  EXPECT_GT(before.translation().x(), 15);
  const std::vector<ImuSample> imu = simulator.imu();
  EXPECT_DOUBLE_EQ(imu.front().time_s, -1);
  EXPECT_NEAR(imu.back().time_s, 0.1 * sweeps, 1e-9);
}

// The scene is fixed in the world: ground points stay at ground level while the sensor sways.
TEST(Simulator, TruePosesPutTheGroundAtItsHeight) {
  Simulator simulator({.range_noise_m = 0});
  for (int i = 0; i < 20; ++i) simulator.next_sweep();
  const SimulatedSweep sweep = simulator.next_sweep();
  std::size_t ground = 0, below = 0;
  for (const Point3f& p : sweep.cloud.positions) {
    const Eigen::Vector3d world = sweep.T_world_sensor * Eigen::Vector3d(p.x, p.y, p.z);
    if (std::hypot(p.x, p.y) > 12) continue;
    if (world.z() < 0.3) ++ground;
    if (world.z() < -0.1) ++below;
  }
  EXPECT_GT(ground, sweep.cloud.size() / 4);
  EXPECT_LT(below, ground / 1000);
}

TEST(Simulator, WorksAtOtherRatesAndSpeeds) {
  for (const double rate_hz : {5.0, 20.0}) {
    Simulator simulator({.sweep_rate_hz = rate_hz, .cruise_speed_mps = 30});
    simulator.next_sweep();
    const SimulatedSweep sweep = simulator.next_sweep();
    EXPECT_DOUBLE_EQ(sweep.time_s, 1 / rate_hz);
    const double columns = static_cast<double>(sweep.cloud.size()) / 64;
    EXPECT_NEAR(columns, 0.87 * 21600 / rate_hz, 0.1 * 21600 / rate_hz);
  }
}

}  // namespace
}  // namespace pointreel
