#include "sim/sensor_geometry.h"

#include <cmath>
#include <numbers>

#include "sim/random.h"

namespace pointreel::sim {
namespace {

constexpr double deg = std::numbers::pi / 180;

// The layout of an HDL-64E: two blocks of 32 lasers with offsets and rotations as its calibration files show.
SensorGeometry make_hdl_64e() {
  struct Block {
    double top_elevation_deg, elevation_step_deg;
    double top_offset_m, offset_step_m;
    double rotation_step_deg, rotation_span_deg, rotation_min_deg;  // steps wrap within the span
    double elevation_tolerance_deg;
  };
  constexpr Block blocks[] = {{2.0, -1.0 / 3, 0.2090, -0.00036, -2.2, 12.1, -7.5, 0.08},
                              {-8.83, -0.521, 0.1259, -0.00032, -3.3, 18.6, -10.7, 0.1}};
  constexpr int lasers_per_block = 32;

  SensorGeometry sensor{{}, 4000, 21600, 0.02, 0.9, 120};
  Random assembly(64);  // every simulated unit is the same one
  for (const Block& b : blocks) {
    for (int i = 0; i < lasers_per_block; ++i) {
      const double rotation_deg = b.rotation_step_deg * i - b.rotation_min_deg;
      const double wrapped_deg = rotation_deg -
                                 b.rotation_span_deg * std::floor(rotation_deg / b.rotation_span_deg) +
                                 b.rotation_min_deg;
      const double tilt_deg = b.elevation_tolerance_deg * assembly.uniform(-1, 1);
      const double twist_deg = assembly.uniform(-0.1, 0.1);
      sensor.lasers.emplace_back((b.top_elevation_deg + b.elevation_step_deg * i + tilt_deg) * deg,
                                 b.top_offset_m + b.offset_step_m * i, i % 2 == 0 ? -0.026 : 0.026,
                                 (wrapped_deg + twist_deg) * deg);
    }
  }
  return sensor;
}

// A VLP-16: the lasers look through one point behind the lens and fire one after the other.
SensorGeometry make_vlp_16(double sweep_rate_hz) {
  constexpr double focal_depth_m = 0.0418;
  constexpr double laser_interval_s = 2.304e-6;

  SensorGeometry sensor{{}, 36000, 18000, 0, 0.4, 100};
  for (int row = 0; row < 16; ++row) {
    const double elevation_rad = (15 - 2 * row) * deg;
    // The unit fires -15, 1, -13, 3, ... 15 deg.
    const int firing_order = row < 8 ? 15 - 2 * row : 2 * (15 - row);
    sensor.lasers.emplace_back(elevation_rad, -focal_depth_m * std::tan(elevation_rad), 0,
                               firing_order * laser_interval_s * sweep_rate_hz * 360 * deg);
  }
  return sensor;
}

}  // namespace

Laser::Laser(double elevation_rad, double vertical_offset_m, double horizontal_offset_m, double rotation_rad)
    : vertical_offset_m_(vertical_offset_m),
      horizontal_offset_m_(horizontal_offset_m),
      rotation_rad_(rotation_rad),
      elevation_(std::cos(elevation_rad), std::sin(elevation_rad)),
      rotation_(std::cos(rotation_rad), std::sin(rotation_rad)) {}

Ray Laser::beam(const Eigen::Vector2d& encoder) const {
  const double c = encoder.x() * rotation_.x() - encoder.y() * rotation_.y();
  const double s = encoder.y() * rotation_.x() + encoder.x() * rotation_.y();
  return {{-horizontal_offset_m_ * s, horizontal_offset_m_ * c, vertical_offset_m_},
          {elevation_.x() * c, elevation_.x() * s, elevation_.y()}};
}

SensorGeometry make_sensor_geometry(SensorKind kind, double sweep_rate_hz) {
  return kind == SensorKind::hdl_64e ? make_hdl_64e() : make_vlp_16(sweep_rate_hz);
}

}  // namespace pointreel::sim
