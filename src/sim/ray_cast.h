// Where a beam meets an object of the street.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim/scene_object.h"

namespace pointreel::sim {

struct Ray {
  Eigen::Vector3d origin_m;
  Eigen::Vector3d direction;  // unit length
};

struct Hit {
  double range_m;
  double cos_incidence;
  Material material;
};

// The first hit nearer than max_range_m. age_s: time since the sweep's start, for objects that move.
std::optional<Hit> cast(const Ray& ray_world, const SceneObject& object, double age_s, double max_range_m);

}  // namespace pointreel::sim
