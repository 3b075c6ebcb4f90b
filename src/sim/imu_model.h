// The IMU on the sensor: true motion plus constant bias and white noise of a decent MEMS unit.
#pragma once

#include <cstdint>
#include <vector>

#include "pointreel/motion.h"
#include "sim/vehicle_motion.h"

namespace pointreel::sim {

inline constexpr double imu_rate_hz = 100;
inline constexpr double standstill_s = 1;  // before time 0
inline constexpr double gravity_mps2 = 9.81;

// Standard deviations; a bias is drawn once per axis, noise at every sample.
inline constexpr double accelerometer_noise_mps2 = 0.02;
inline constexpr double accelerometer_bias_mps2 = 0.02;
inline constexpr double gyro_noise_radps = 0.001;
inline constexpr double gyro_bias_radps = 0.0005;

// Samples from the start of the standstill until the first at or after end_time_s.
std::vector<ImuSample> simulate_imu(const VehicleMotion& motion, double end_time_s, std::uint64_t seed);

}  // namespace pointreel::sim
