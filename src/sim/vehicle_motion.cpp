#include "sim/vehicle_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pointreel::sim {
namespace {

constexpr double sensor_height_m = 1.73;
constexpr double peak_acceleration_mps2 = 2.5;
// Speed rises and falls by this share along the road, as for turns and traffic.
constexpr double speed_variation = 0.2;
constexpr double speed_variation_radpm = 2 * std::numbers::pi / 150;

// Smootherstep 6u^5 - 15u^4 + 10u^3 of time / duration: zero first and second derivatives at both ends.
Jet smootherstep(double time_s, double duration_s) {
  if (time_s <= 0) return 0;
  if (time_s >= duration_s) return 1;
  const Jet u(time_s / duration_s, 1 / duration_s, 0);
  return u * u * u * (u * (u * 6 - 15) + 10);
}

// Integral of smootherstep from 0, seconds.
Jet smootherstep_integral(double time_s, double duration_s) {
  if (time_s <= 0) return 0;
  if (time_s >= duration_s) return {time_s - duration_s / 2, 1, 0};
  const Jet u(time_s / duration_s, 1 / duration_s, 0);
  return duration_s * (u * u * u * u * (u * (u - 3) + 2.5));
}

}  // namespace

VehicleMotion::VehicleMotion(const Road& road, double cruise_speed_mps, std::uint64_t seed)
    : road_(road),
      cruise_speed_mps_(cruise_speed_mps),
      pull_away_s_(1.875 * cruise_speed_mps / peak_acceleration_mps2),  // 1.875: steepest smootherstep
      sway_phase_rad_(Random(seed).uniform(0, 2 * std::numbers::pi)) {}

Jet VehicleMotion::moving_share(double time_s) const {
  return cruise_speed_mps_ > 0 ? smootherstep(time_s, pull_away_s_) : Jet(0);
}

Jet VehicleMotion::road_position(double time_s) const {
  if (cruise_speed_mps_ <= 0) return 0;
  const Jet x_m = cruise_speed_mps_ * smootherstep_integral(time_s, pull_away_s_);
  return x_m + speed_variation / speed_variation_radpm * (1 - cos(speed_variation_radpm * x_m));
}

VehicleState VehicleMotion::state(double time_s) const {
  const Jet x = road_position(time_s);
  const Jet y = road_.y_m(x) - lane_centre_m;
  const Jet yaw = road_.heading_rad(x);
  const Jet share = moving_share(time_s);
  const auto sway = [&](double amplitude, double frequency_hz) {
    const double radps = 2 * std::numbers::pi * frequency_hz;
    return amplitude * share * sin(radps * Jet::time(time_s) + sway_phase_rad_ * frequency_hz);
  };
  const Jet z = sensor_height_m + sway(0.012, 1.3);
  const Jet pitch = sway(0.005, 1.1) + sway(0.003, 0.35);
  const Jet roll = sway(0.004, 0.9) + sway(0.004, 0.27);

  VehicleState state;
  using Eigen::AngleAxisd, Eigen::Vector3d;
  state.T_world_sensor.linear() =
      (AngleAxisd(yaw.value, Vector3d::UnitZ()) * AngleAxisd(pitch.value, Vector3d::UnitY()) *
       AngleAxisd(roll.value, Vector3d::UnitX()))
          .toRotationMatrix();
  state.T_world_sensor.translation() = Vector3d(x.value, y.value, z.value);
  state.acceleration_world_mps2 = Vector3d(x.acceleration, y.acceleration, z.acceleration);
  // Body rates of yaw-pitch-roll angles.
  const double sin_p = std::sin(pitch.value), cos_p = std::cos(pitch.value);
  const double sin_r = std::sin(roll.value), cos_r = std::cos(roll.value);
  state.rotation_rate_sensor_radps =
      Vector3d(roll.rate - yaw.rate * sin_p,  //
               pitch.rate * cos_r + yaw.rate * cos_p * sin_r, -pitch.rate * sin_r + yaw.rate * cos_p * cos_r);
  return state;
}

}  // namespace pointreel::sim
