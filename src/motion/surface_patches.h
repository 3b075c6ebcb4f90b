// Small flat pieces of a sweep's surfaces, spread over all directions they face.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "motion/range_grid.h"

namespace pointreel {

struct SurfacePatch {
  Eigen::Vector3f center_m;
  Eigen::Vector3f normal;  // of unit length, either way
};

// Ground, and four directions of walls. None may take more than its share, or the few surfaces that tell how
// far the sensor went would drown among those along the way.
inline constexpr int kFacings = 5;
inline int facing(const Eigen::Vector3f& normal) {
  constexpr float kLevel = 0.8F;
  if (std::fabs(normal.z()) > kLevel) return 0;
  const bool steep = std::fabs(normal.y()) > std::fabs(normal.x());
  const bool same_sign = normal.x() * normal.y() > 0;
  return 1 + (steep ? 2 : 0) + (same_sign ? 1 : 0);
}

// At most `most`, in no particular order: any first part of the list is spread as the whole.
std::vector<SurfacePatch> find_surface_patches(const GridRays& sweep, int most);

}  // namespace pointreel
