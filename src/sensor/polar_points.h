// Points of a sweep in cylinder coordinates around the sensor's axis, as measured (before compensation).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/raw_vector.h"
#include "pointreel/point_cloud.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Structure of arrays; azimuths to 5e-7 rad. Points without a ray have rho 0.
struct PolarPoints {
  RawVector<float> rho_m, azimuth_rad, z_m;  // azimuth in [-pi, pi]
  std::size_t size() const { return rho_m.size(); }
  bool has_ray(std::size_t i) const { return rho_m[i] > 0; }
};

inline constexpr float kLeastRhoM = 1e-3F;  // nearer to the axis there is no direction to speak of
inline constexpr float kMostRhoM = 1e5F;    // farther away float32 has no centimetres

// Under the motion that the cloud was compensated for, if there is one.
PolarPoints polar_points(const PointCloud& cloud, const std::optional<Twist>& motion, int threads);

}  // namespace pointreel
