// What the street is made of.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pointreel::sim {

enum class Material : std::uint8_t {
  asphalt,
  marking,
  paving,
  grass,
  plaster,
  brick,
  glass,
  paint,
  rubber,
  metal,
  wood,
  leaves
};

struct MaterialProperties {
  double reflectivity;  // 0 to 1
  double roughness_m;   // standard deviation of the surface along the beam, on top of the sensor's noise
  double drop_out;      // share of shots lost, on top of the sensor's
};

inline const MaterialProperties& properties(Material material) {
  static constexpr std::array<MaterialProperties, 12> table = {{{0.30, 0.002, 0},
                                                                {0.60, 0.002, 0},
                                                                {0.36, 0.002, 0},
                                                                {0.42, 0.020, 0},
                                                                {0.45, 0.001, 0},
                                                                {0.34, 0.004, 0},
                                                                {0.12, 0.002, 0.9},
                                                                {0.40, 0.002, 0.06},
                                                                {0.06, 0.003, 0.2},
                                                                {0.50, 0.001, 0},
                                                                {0.30, 0.004, 0},
                                                                {0.38, 0.015, 0.02}}};
  return table[static_cast<std::size_t>(material)];
}

enum class Shape : std::uint8_t {
  box,       // solid
  building,  // box with recessed windows
  slats,     // thin box with gaps that let the beam through
  cylinder,  // upright; half_size_m.x() is the radius
  foliage    // ellipsoid filled with leaves; most of it is air
};

// Upright, turned about z only. half_size_m and yaw describe its footprint.
struct SceneObject {
  Shape shape;
  Material material;
  std::uint64_t salt;  // its own details
  Eigen::Vector2d center_m;
  Eigen::Vector2d half_size_m;
  double cos_yaw, sin_yaw;
  double z_min_m, z_max_m;
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();  // center_m is its place at the sweep's start
};

// Turned from footprint axes to world axes, and back.
inline Eigen::Vector2d to_world(const SceneObject& o, const Eigen::Vector2d& v) {
  return {o.cos_yaw * v.x() - o.sin_yaw * v.y(), o.sin_yaw * v.x() + o.cos_yaw * v.y()};
}
inline Eigen::Vector2d to_footprint(const SceneObject& o, const Eigen::Vector2d& v) {
  return {o.cos_yaw * v.x() + o.sin_yaw * v.y(), o.cos_yaw * v.y() - o.sin_yaw * v.x()};
}

}  // namespace pointreel::sim
