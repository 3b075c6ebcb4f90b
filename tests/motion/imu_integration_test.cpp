#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <random>

#include "pointreel/motion.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kStep_s = 0.01;

double between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 10001) / 10000.0;
}

std::vector<ImuSample> steady_samples(std::size_t count, const Vec3& acceleration_mps2,
                                      const Vec3& rate_radps) {
  std::vector<ImuSample> samples(count);
  for (std::size_t k = 0; k < count; ++k) {
    samples[k] = {static_cast<double>(k) * kStep_s, acceleration_mps2, rate_radps, {}};
  }
  return samples;
}

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

RC_GTEST_PROP(IntegrateImu, ConstantAccelerationGivesTheParabola, ()) {
  const Vec3 acceleration(between(-5, 5), 0, 0);  // too small to be taken for gravity
  ImuIntegrationOptions options;
  options.initial_velocity_mps = Vec3(between(-20, 20), between(-1, 1), 0);
  const auto samples = steady_samples(300, acceleration, Vec3::Zero());
  const auto track = integrate_imu(samples, options);
  RC_ASSERT(static_cast<bool>(track));
  RC_ASSERT(track->size() == samples.size());
  for (const TimedPose& pose : *track) {
    const double t = pose.time_s;
    const Vec3 expected = options.initial_velocity_mps * t + acceleration * t * t / 2;
    RC_ASSERT((pose.T_world_sensor.translation() - expected).norm() < 1e-9);
    RC_ASSERT(pose.T_world_sensor.linear().isIdentity());
  }
}

RC_GTEST_PROP(IntegrateImu, ConstantRateGivesTheAngle, ()) {
  const Vec3 axis = Vec3(between(-1, 1), between(-1, 1), 1).normalized();
  const double rate_radps = between(0.1, 2);
  const auto track = integrate_imu(steady_samples(150, Vec3::Zero(), rate_radps * axis));
  RC_ASSERT(static_cast<bool>(track));
  for (const TimedPose& pose : *track) {
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(rate_radps * pose.time_s, axis).toRotationMatrix();
    RC_ASSERT(pose.T_world_sensor.linear().isApprox(expected, 1e-12));
    RC_ASSERT(pose.T_world_sensor.translation().norm() == 0);
  }
}

// A full circle without a rest before it: gravity has to come from the mean, whatever way the unit is tilted.
RC_GTEST_PROP(IntegrateImu, CircleWithGravityClosesAndKeepsItsRadius, ()) {
  const double radius_m = between(10, 50);
  const auto steps = static_cast<std::size_t>(*rc::gen::inRange(300, 1000));
  const double turn_rad = *rc::gen::arbitrary<bool>() ? 2 * M_PI : -2 * M_PI;
  const double yaw_rate_radps = turn_rad / (static_cast<double>(steps) * kStep_s);
  const Eigen::Matrix3d R_tilted_level = (Eigen::AngleAxisd(between(-0.2, 0.2), Vec3::UnitX()) *
                                          Eigen::AngleAxisd(between(-0.2, 0.2), Vec3::UnitY()))
                                             .toRotationMatrix();
  const double speed_mps = radius_m * std::abs(yaw_rate_radps);
  const Vec3 specific_force(0, speed_mps * yaw_rate_radps, 9.81);
  const auto samples =
      steady_samples(steps + 1, R_tilted_level * specific_force, R_tilted_level * Vec3(0, 0, yaw_rate_radps));
  ImuIntegrationOptions options;
  options.initial_velocity_mps = R_tilted_level * Vec3(speed_mps, 0, 0);
  const auto track = integrate_imu(samples, options);
  RC_ASSERT(static_cast<bool>(track));

  const Vec3 centre = R_tilted_level * Vec3(0, std::copysign(radius_m, yaw_rate_radps), 0);
  for (const TimedPose& pose : *track) {
    RC_ASSERT(std::abs((pose.T_world_sensor.translation() - centre).norm() - radius_m) < 1e-3 * radius_m);
  }
  RC_ASSERT(track->back().T_world_sensor.translation().norm() < 1e-3 * radius_m);
  RC_ASSERT(track->back().T_world_sensor.linear().isIdentity(1e-9));
}

// One second at rest, then a straight start; the unit is tilted, biased and noisy.
std::vector<ImuSample> start_from_rest(double acceleration_mps2, const Eigen::Matrix3d& R_tilted_level,
                                       const Vec3& gyro_bias_radps, double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 1);
  const auto noise_vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  auto samples = steady_samples(501, Vec3::Zero(), Vec3::Zero());
  for (ImuSample& sample : samples) {
    const Vec3 level(sample.time_s > 1 + kStep_s / 2 ? acceleration_mps2 : 0, 0, 9.79);
    sample.acceleration_mps2 = R_tilted_level * level + 0.05 * noise * noise_vector();
    sample.rotation_rate_radps = gyro_bias_radps + 0.005 * noise * noise_vector();
  }
  return samples;
}

TEST(IntegrateImu, LeadInRemovesGravityAndGyroBias) {
  const Eigen::Matrix3d R_tilted_level =
      Eigen::AngleAxisd(0.1, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  const Vec3 gyro_bias(0.01, -0.015, 0.008);
  const auto track = integrate_imu(start_from_rest(2, R_tilted_level, gyro_bias, 0));
  ASSERT_TRUE(track) << track.error().message;
  // The acceleration appears between two samples, so the trapezoid starts half a step before the second.
  const double moving_s = track->back().time_s - 1 - kStep_s / 2;
  const Vec3 expected = R_tilted_level * Vec3(2 * moving_s * moving_s / 2, 0, 0);
  EXPECT_LT((track->back().T_world_sensor.translation() - expected).norm(), 1e-3);
  EXPECT_LT(angle_between(track->back().T_world_sensor, Pose::Identity()), 1e-9);
}

TEST(IntegrateImu, LeadInIsFoundInNoise) {
  const auto track = integrate_imu(start_from_rest(2, Eigen::Matrix3d::Identity(), Vec3(0.01, 0, 0.01), 1));
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_NEAR(track->back().T_world_sensor.translation().x(), 16, 0.5);
  EXPECT_LT(angle_between(track->back().T_world_sensor, Pose::Identity()), 0.01);
}

TEST(IntegrateImu, SteadyTurnAtTheStartIsNoBias) {
  const double rate_radps = 0.1;
  const auto track = integrate_imu(steady_samples(101, Vec3(0, 0, 9.81), Vec3(0, 0, rate_radps)));
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_NEAR(angle_between(track->back().T_world_sensor, Pose::Identity()), rate_radps, 1e-9);
}

TEST(IntegrateImu, SlowTurnWhileDrivingIsNoBias) {
  ImuIntegrationOptions options;
  options.initial_velocity_mps = Vec3(10, 0, 0);
  const auto samples = steady_samples(101, Vec3(0, 0.1, 9.81), Vec3(0, 0, 0.01));
  const auto track = integrate_imu(samples, options);
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_NEAR(angle_between(track->back().T_world_sensor, Pose::Identity()), 0.01, 1e-9);
}

TEST(IntegrateImu, MeasuredVelocitiesAreUsed) {
  // Accelerations that would lead far away, were they integrated.
  auto samples = steady_samples(101, Vec3(3, 2, 1), Vec3(0, 0, 0.5));
  for (ImuSample& sample : samples) sample.velocity_mps = Vec3(10, 0, 0);
  const auto track = integrate_imu(samples);
  ASSERT_TRUE(track) << track.error().message;
  const double angle_rad = 0.5;
  const double radius_m = 10 / 0.5;
  const Vec3 expected(radius_m * std::sin(angle_rad), radius_m * (1 - std::cos(angle_rad)), 0);
  EXPECT_LT((track->back().T_world_sensor.translation() - expected).norm(), 1e-3);
}

TEST(IntegrateImu, GapsInTheVelocityAreBridgedByAcceleration) {
  auto samples = steady_samples(101, Vec3(1, 0, 0), Vec3::Zero());
  for (std::size_t k = 0; k < samples.size(); k += 50)
    samples[k].velocity_mps = Vec3(samples[k].time_s, 0, 0);
  const auto track = integrate_imu(samples);
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_NEAR(track->back().T_world_sensor.translation().x(), 0.5, 1e-9);
}

TEST(IntegrateImu, RejectsSamplesItCannotUse) {
  const auto rejected = [](const std::vector<ImuSample>& samples, const char* complaint) {
    expect_error(integrate_imu(samples), ErrorCode::invalid_argument, complaint);
  };
  const auto good = steady_samples(3, Vec3::Zero(), Vec3::Zero());
  rejected({}, "no IMU samples");
  auto bad = good;
  bad[2].time_s = bad[1].time_s;
  rejected(bad, "time of IMU sample 2 is not after");
  bad = good;
  bad[1].time_s = std::numeric_limits<double>::quiet_NaN();
  rejected(bad, "IMU sample 1 holds a number that is not finite");
  bad = good;
  bad[0].acceleration_mps2.y() = std::numeric_limits<double>::infinity();
  rejected(bad, "IMU sample 0");
}

TEST(IntegrateImu, OneSampleIsTheStart) {
  const auto track = integrate_imu(steady_samples(1, Vec3(0, 0, 9.81), Vec3::Zero()));
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->size(), 1u);
  EXPECT_TRUE(track->front().T_world_sensor.isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace pointreel
