// Small flat pieces of a sweep's surfaces, spread over all directions they face.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/range_grid.h"

namespace pointreel {

struct SurfacePatch {
  Eigen::Vector3f center_m;
  Eigen::Vector3f normal;  // of unit length, either way
};

// At most `most`, in no particular order: any first part of the list is spread as the whole.
std::vector<SurfacePatch> find_surface_patches(const GridRays& sweep, int most);

}  // namespace pointreel
