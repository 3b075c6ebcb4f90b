#include "sim/imu_model.h"

#include <cmath>

#include "sim/random.h"

namespace pointreel::sim {
namespace {

Eigen::Vector3d normal_vector(Random& random) {
  const double x = random.normal();
  const double y = random.normal();
  const double z = random.normal();
  return {x, y, z};
}

}  // namespace

std::vector<ImuSample> simulate_imu(const VehicleMotion& motion, double end_time_s, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector3d acceleration_bias = accelerometer_bias_mps2 * normal_vector(random);
  const Eigen::Vector3d gyro_bias = gyro_bias_radps * normal_vector(random);
  const Eigen::Vector3d gravity_world(0, 0, -gravity_mps2);

  // The margin keeps rounding of end_time_s from adding a sample.
  const auto count =
      static_cast<std::size_t>(std::ceil((end_time_s + standstill_s) * imu_rate_hz - 1e-6)) + 1;
  std::vector<ImuSample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    ImuSample& sample = samples[i];
    sample.time_s = static_cast<double>(i) / imu_rate_hz - standstill_s;
    const VehicleState truth = motion.state(sample.time_s);
    const Eigen::Vector3d specific_force =
        truth.T_world_sensor.linear().transpose() * (truth.acceleration_world_mps2 - gravity_world);
    sample.acceleration_mps2 =
        specific_force + acceleration_bias + accelerometer_noise_mps2 * normal_vector(random);
    sample.rotation_rate_radps =
        truth.rotation_rate_sensor_radps + gyro_bias + gyro_noise_radps * normal_vector(random);
  }
  return samples;
}

}  // namespace pointreel::sim
