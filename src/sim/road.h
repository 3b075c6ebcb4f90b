// The road's centre line y(x): an endless, gently winding curve. World coordinates: x along the road, z up.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sim/random.h"

namespace pointreel::sim {

// Distances from the centre line, metres. Traffic keeps to the right, which is -y.
inline constexpr double lane_centre_m = 1.8;
inline constexpr double parking_centre_m = 4.7;
inline constexpr double curb_lateral_m = 5.8;
inline constexpr double sidewalk_end_m = 8.4;

class Road {
 public:
  explicit Road(std::uint64_t seed) {
    Random random(seed);
    for (Wave& wave : waves_) wave.phase_rad = random.uniform(0, 2 * std::numbers::pi);
  }

  // T is double, or Jet where derivatives with respect to time are wanted.
  template <class T>
  T y_m(const T& x_m) const {
    using std::sin;
    T y = 0;
    for (const Wave& w : waves_) y = y + w.slope / w.radpm * sin(w.radpm * x_m + w.phase_rad);
    return y;
  }
  template <class T>
  T heading_rad(const T& x_m) const {
    using std::atan;
    using std::cos;
    T slope = 0;
    for (const Wave& w : waves_) slope = slope + w.slope * cos(w.radpm * x_m + w.phase_rad);
    return atan(slope);
  }

  // The point `lateral_m` to the left of the centre line at x_m.
  Eigen::Vector2d beside(double x_m, double lateral_m) const {
    const double heading = heading_rad(x_m);
    return {x_m - lateral_m * std::sin(heading), y_m(x_m) + lateral_m * std::cos(heading)};
  }

 private:
  struct Wave {
    double slope = 0;  // amplitude of dy/dx
    double radpm = 0;
    double phase_rad = 0;
  };
  // Tightest curve: radius about 110 m.
  std::array<Wave, 2> waves_ = {Wave{0.22, 2 * std::numbers::pi / 310},
                                Wave{0.08, 2 * std::numbers::pi / 130}};
};

}  // namespace pointreel::sim
