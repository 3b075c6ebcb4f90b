// A car or van as a few boxes.
#pragma once

#include <vector>

#include "sim/scene_object.h"

namespace pointreel::sim {

struct CarPlacement {
  Eigen::Vector2d center_m;
  double yaw_rad = 0;
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
};

// The salt decides kind and size.
void append_car(const CarPlacement& placement, std::uint64_t salt, std::vector<SceneObject>& objects);

}  // namespace pointreel::sim
