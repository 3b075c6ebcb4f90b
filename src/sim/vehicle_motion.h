// How the car carrying the sensor moves: a smooth function of time with exact derivatives.
#pragma once

#include <cstdint>

#include "pointreel/motion.h"
#include "sim/jet.h"
#include "sim/road.h"

namespace pointreel::sim {

struct VehicleState {
  Pose T_world_sensor = Pose::Identity();
  Eigen::Vector3d acceleration_world_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rate_sensor_radps = Eigen::Vector3d::Zero();
};

// At rest until time 0, then pulls away along the road's right lane; sways a little while it moves.
class VehicleMotion {
 public:
  VehicleMotion(const Road& road, double cruise_speed_mps, std::uint64_t seed);

  VehicleState state(double time_s) const;
  double road_position_m(double time_s) const { return road_position(time_s).value; }  // world x

 private:
  Jet road_position(double time_s) const;
  Jet moving_share(double time_s) const;  // 0 at rest to 1 at cruising speed

  const Road& road_;
  double cruise_speed_mps_;
  double pull_away_s_;
  double sway_phase_rad_;
};

}  // namespace pointreel::sim
