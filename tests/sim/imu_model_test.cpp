#include "sim/imu_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pointreel::sim {
namespace {

using Eigen::Vector3d;

class ImuModelTest : public testing::Test {
 protected:
  Road road_{21};
  VehicleMotion motion_{road_, 8, 22};
};

TEST_F(ImuModelTest, SamplesFromStandstillToTheEnd) {
  const std::vector<ImuSample> samples = simulate_imu(motion_, 0.3, 5);
  ASSERT_EQ(samples.size(), 131u);
  EXPECT_DOUBLE_EQ(samples.front().time_s, -1);
  EXPECT_DOUBLE_EQ(samples.back().time_s, 0.3);
  EXPECT_EQ(simulate_imu(motion_, 0.301, 5).size(), 132u);
}

TEST_F(ImuModelTest, LongerDrivesStartWithTheSameSamples) {
  const std::vector<ImuSample> brief = simulate_imu(motion_, 1, 5), extended = simulate_imu(motion_, 2, 5);
  for (std::size_t i = 0; i < brief.size(); ++i) {
    EXPECT_EQ(brief[i].acceleration_mps2, extended[i].acceleration_mps2);
    EXPECT_EQ(brief[i].rotation_rate_radps, extended[i].rotation_rate_radps);
  }
}

TEST_F(ImuModelTest, NoiseHasItsStandardDeviation) {
  const std::vector<ImuSample> samples = simulate_imu(motion_, 0, 5);
  Vector3d mean = Vector3d::Zero();
  for (const ImuSample& s : samples) mean += s.acceleration_mps2 / static_cast<double>(samples.size());
  EXPECT_NEAR(mean.z(), gravity_mps2, 5 * accelerometer_bias_mps2);
  double sum_of_squares = 0;
  for (const ImuSample& s : samples) sum_of_squares += (s.acceleration_mps2 - mean).squaredNorm();
  const double deviation = std::sqrt(sum_of_squares / (3 * static_cast<double>(samples.size())));
  EXPECT_NEAR(deviation, accelerometer_noise_mps2, 0.15 * accelerometer_noise_mps2);
}

TEST_F(ImuModelTest, IntegratesToTheTrueTrack) {
  constexpr double end_s = 2.5;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<ImuSample> samples = simulate_imu(motion_, end_s, seed);
    // The standstill gives the bias of the gyro and gravity as the accelerometer sees it.
    Vector3d gyro_bias = Vector3d::Zero(), resting_force = Vector3d::Zero();
    std::size_t first = 0;
    for (; samples[first].time_s < -1e-9; ++first) {
      gyro_bias += samples[first].rotation_rate_radps;
      resting_force += samples[first].acceleration_mps2;
    }
    gyro_bias /= static_cast<double>(first);
    resting_force /= static_cast<double>(first);

    Pose T_world_sensor = motion_.state(0).T_world_sensor;
    const Vector3d gravity_world = T_world_sensor.linear() * resting_force;
    Vector3d velocity = Vector3d::Zero();
    for (std::size_t i = first; i + 1 < samples.size(); ++i) {
      const double dt = samples[i + 1].time_s - samples[i].time_s;
      const Vector3d turn =
          (0.5 * (samples[i].rotation_rate_radps + samples[i + 1].rotation_rate_radps) - gyro_bias) * dt;
      const Eigen::Matrix3d before = T_world_sensor.linear();
      const Eigen::Matrix3d after =
          before * Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
      const Vector3d acceleration =
          0.5 * (before * samples[i].acceleration_mps2 + after * samples[i + 1].acceleration_mps2) -
          gravity_world;
      T_world_sensor.translation() += velocity * dt + 0.5 * acceleration * dt * dt;
      velocity += acceleration * dt;
      T_world_sensor.linear() = after;
    }

    // Standard deviations: position error t^2 / 2 * noise / sqrt(samples at rest) from gravity's estimate,
    // t^3 / 6 * g * noise / sqrt(samples at rest) from the gyro bias's, less from the noise under way, and
    // the constant bias turns with the car: t^2 / 2 * bias * heading change (0.1 rad).
    const double at_rest = std::sqrt(static_cast<double>(first));
    const double sigma_m = end_s * end_s / 2 * accelerometer_noise_mps2 / at_rest +
                           end_s * end_s * end_s / 6 * gravity_mps2 * gyro_noise_radps / at_rest +
                           end_s * std::sqrt(end_s / imu_rate_hz / 3) * accelerometer_noise_mps2 +
                           end_s * end_s / 2 * accelerometer_bias_mps2 * 0.1;
    const Pose truth = motion_.state(end_s).T_world_sensor;
    EXPECT_GT((truth.translation() - motion_.state(0).T_world_sensor.translation()).norm(), 1);
    EXPECT_LT((T_world_sensor.translation() - truth.translation()).norm(), 4 * sigma_m);
  }
}

}  // namespace
}  // namespace pointreel::sim
