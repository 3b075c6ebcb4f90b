// A scene of planes and pillars, and what a spinning sensor sees of it, at rest or on its way.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "motion/range_grid.h"
#include "pointreel/motion.h"

namespace pointreel {

// Points with normal.dot(p) = distance_m.
struct Plane {
  Eigen::Vector3d normal;
  double distance_m;
};

// Upright and round, from the ground to the sky.
struct Pillar {
  Eigen::Vector2d middle_m;
  double radius_m;
};

// Where the line begin + rho * along first meets a pillar; infinity: it does not.
inline double meets(const Pillar& pillar, const Eigen::Vector2d& begin, const Eigen::Vector2d& along) {
  const Eigen::Vector2d away = begin - pillar.middle_m;
  const double a = along.squaredNorm(), half_b = away.dot(along);
  const double root = half_b * half_b - a * (away.squaredNorm() - pillar.radius_m * pillar.radius_m);
  return root < 0 ? std::numeric_limits<double>::infinity() : (-half_b - std::sqrt(root)) / a;
}

struct SceneView {
  std::vector<GridRow> rows;
  std::vector<double> column_azimuth_rad;
  std::vector<float> range_m;
  RangeGrid grid() const { return {rows, column_azimuth_rad, range_m}; }
};

// `T_world_sensor(azimuth_rad)`: where the sensor is when it looks there.
template <class PoseAt>
SceneView view_along(const std::vector<Plane>& scene, const PoseAt& T_world_sensor,
                     const std::vector<Pillar>& pillars = {}, int rows = 32) {
  constexpr int kColumns = 900;
  constexpr double kFarthestM = 120;
  SceneView view;
  for (int r = 0; r < rows; ++r) {
    // Offsets and turned rows, as real sensors have them.
    view.rows.push_back({std::tan((10.0 - 32.0 / rows * r) * std::numbers::pi / 180), r % 2 == 0 ? 0.2 : 0.1,
                         0.1 * (r % 4), r % 2 == 0 ? 0.02 : -0.02});
  }
  for (int c = 0; c < kColumns; ++c) view.column_azimuth_rad.push_back(2 * std::numbers::pi * c / kColumns);
  for (const GridRow& row : view.rows) {
    for (const double column_rad : view.column_azimuth_rad) {
      // Two points of the ray, far apart, give its direction; the side offset bends it a little.
      const double azimuth_rad = column_rad + row.azimuth_rad;
      const Eigen::Vector3d side(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0);
      const Eigen::Vector3d ahead(std::cos(azimuth_rad), std::sin(azimuth_rad), row.slope);
      const Pose pose = T_world_sensor(azimuth_rad);
      const Eigen::Vector3d begin =
          pose * Eigen::Vector3d(row.side_offset_m * side + row.offset_m * Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d along = pose.linear() * ahead;
      double nearest_m = std::numeric_limits<double>::infinity();  // as rho
      for (const Plane& plane : scene) {
        const double rho_m = (plane.distance_m - plane.normal.dot(begin)) / plane.normal.dot(along);
        if (rho_m > 0.5 && rho_m < nearest_m) nearest_m = rho_m;
      }
      for (const Pillar& pillar : pillars) {
        const double rho_m = meets(pillar, begin.head<2>(), along.head<2>());
        if (rho_m > 0.5 && rho_m < nearest_m) nearest_m = rho_m;
      }
      const double range_m = nearest_m * ahead.norm();
      view.range_m.push_back(range_m < kFarthestM ? static_cast<float>(range_m) : 0);
    }
  }
  return view;
}

inline SceneView view_of(const std::vector<Plane>& scene, const Pose& T_world_sensor,
                         const std::vector<Pillar>& pillars = {}) {
  return view_along(
      scene, [&](double) { return T_world_sensor; }, pillars);
}

// Each return off by some 2 cm.
inline SceneView noisy(SceneView view, std::mt19937& random) {
  std::normal_distribution<float> noise_m(0, 0.02F);
  for (float& range_m : view.range_m) range_m += range_m > 0 ? noise_m(random) : 0;
  return view;
}

inline std::vector<Plane> ground() {
  return {{Eigen::Vector3d::UnitZ(), -1.8}};
}
// A street between two houses that never end.
inline std::vector<Plane> tunnel() {
  auto scene = ground();
  scene.push_back({Eigen::Vector3d::UnitZ(), 4});
  scene.push_back({Eigen::Vector3d::UnitY(), 6});
  scene.push_back({Eigen::Vector3d::UnitY(), -5});
  return scene;
}
inline std::vector<Plane> hall() {
  auto scene = tunnel();
  scene.push_back({Eigen::Vector3d::UnitX(), 25});
  scene.push_back({Eigen::Vector3d(1, 0.2, 0).normalized(), -30});
  return scene;
}

inline Pose pose_of(double forward_m, double left_m, double up_m, double yaw_deg) {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::AngleAxisd(yaw_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() << forward_m, left_m, up_m;
  return pose;
}

}  // namespace pointreel
