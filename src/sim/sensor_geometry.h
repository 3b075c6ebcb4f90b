// Where each laser of a spinning LiDAR sits and points, and when it fires.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pointreel/simulator.h"
#include "sim/ray_cast.h"

namespace pointreel::sim {

// Laser k at encoder angle t sees z = slope_k * rho + vertical_offset_k, rho = hypot(x, y), at
// azimuth = t + rotation_k + horizontal_offset_k / rho.
class Laser {
 public:
  Laser(double elevation_rad, double vertical_offset_m, double horizontal_offset_m, double rotation_rad);

  double slope() const { return elevation_.y() / elevation_.x(); }
  double vertical_offset_m() const { return vertical_offset_m_; }
  double horizontal_offset_m() const { return horizontal_offset_m_; }  // to the left
  double rotation_rad() const { return rotation_rad_; }

  // Its beam in sensor coordinates while the encoder shows (cos, sin) of its angle.
  Ray beam(const Eigen::Vector2d& encoder) const;

 private:
  double vertical_offset_m_, horizontal_offset_m_, rotation_rad_;
  Eigen::Vector2d elevation_, rotation_;  // (cos, sin)
};

struct SensorGeometry {
  std::vector<Laser> lasers;   // top to bottom
  int ticks_per_revolution;    // resolution of the encoder
  double firings_per_s;        // all lasers fire together
  double firing_jitter_ticks;  // deviation of a step between firings, from uneven rotation
  double min_range_m;
  double max_range_m;
};

SensorGeometry make_sensor_geometry(SensorKind kind, double sweep_rate_hz);

}  // namespace pointreel::sim
