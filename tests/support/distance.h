// The distance that bounds are about.
#pragma once

#include <cmath>

#include "pointreel/point_cloud.h"

namespace pointreel {

// In space, in double.
inline double distance_between_m(const Point3f& a, const Point3f& b) {
  return std::hypot(static_cast<double>(a.x) - b.x, static_cast<double>(a.y) - b.y,
                    static_cast<double>(a.z) - b.z);
}

}  // namespace pointreel
