// PatchBlock: a few patches where a pose takes them, as arrays, and how far a reference is from their planes.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "motion/surface_patches.h"

namespace pointreel {

struct PatchBlock {
  static constexpr std::size_t kLanes = 8, kMost = 8 * kLanes;
  static constexpr float kNoPartner = std::numeric_limits<float>::infinity();

  std::size_t count = 0;
  std::array<float, kMost> x_m, y_m, z_m;  // of the centers; 0 in lanes beyond `count`
  std::array<float, kMost> normal_x, normal_y, normal_z;
  std::array<float, kMost> distance_m;  // kNoPartner: nothing is there

  void set(std::size_t i, const Eigen::Vector3f& center_m, const Eigen::Vector3f& normal) {
    x_m[i] = center_m.x();
    y_m[i] = center_m.y();
    z_m[i] = center_m.z();
    normal_x[i] = normal.x();
    normal_y[i] = normal.y();
    normal_z[i] = normal.z();
  }
  Eigen::Vector3f center_m(std::size_t i) const { return {x_m[i], y_m[i], z_m[i]}; }
  Eigen::Vector3f normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
};

}  // namespace pointreel
