#include "sim/ray_cast.h"

#include <algorithm>
#include <cmath>

#include "sim/random.h"

namespace pointreel::sim {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Where a ray is inside a box around the origin, and the axis of the side it enters by.
struct Passage {
  double enter_m, exit_m;
  int axis;
};

std::optional<Passage> pass_box(const Ray& ray, const Vector3d& half_size_m) {
  Passage passage{-1e9, 1e9, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1 / ray.direction[axis];  // +-inf keeps the comparisons right
    double enter = (-half_size_m[axis] - ray.origin_m[axis]) * inverse;
    double exit = (half_size_m[axis] - ray.origin_m[axis]) * inverse;
    if (enter > exit) std::swap(enter, exit);
    if (enter > passage.enter_m) passage.enter_m = enter, passage.axis = axis;
    passage.exit_m = std::min(passage.exit_m, exit);
    if (passage.enter_m > passage.exit_m) return std::nullopt;
  }
  if (passage.enter_m <= 0) return std::nullopt;  // behind, or the sensor is inside
  return passage;
}

double fraction(double v) {
  return v - std::floor(v);
}

// A number in [0, 1) fixed for the object; `which` tells several apart.
double detail(const SceneObject& object, std::uint64_t which) {
  return to_unit_interval(combine(object.salt, which));
}

// Windows in a regular pattern, recessed into the wall that the ray enters by.
Hit cast_facade(const Ray& ray, const SceneObject& object, const Vector3d& half_size_m,
                const Passage& passage) {
  const double cos_wall = std::abs(ray.direction[passage.axis]);
  const Hit wall{passage.enter_m, cos_wall, object.material};
  if (passage.axis == 2) return wall;

  const double bay_m = 2.4 + 1.2 * detail(object, 0);
  const double floor_m = 2.8 + 0.5 * detail(object, 1);
  const double half_window_m = bay_m * (0.18 + 0.14 * detail(object, 2));
  const double sill_m = 0.9, lintel_m = 2.3;
  const double recess_m = 0.1 + 0.25 * detail(object, 3);

  const int along = 1 - passage.axis;
  const double u_m = ray.origin_m[along] + passage.enter_m * ray.direction[along] + half_size_m[along];
  const double v_m = ray.origin_m.z() + passage.enter_m * ray.direction.z() + half_size_m.z();
  const double from_window_middle_m = (fraction(u_m / bay_m) - 0.5) * bay_m;
  const double above_floor_m = fraction(v_m / floor_m) * floor_m;
  const bool in_window = std::abs(from_window_middle_m) < half_window_m && above_floor_m > sill_m &&
                         above_floor_m < lintel_m && u_m < 2 * half_size_m[along] - bay_m / 4;
  if (!in_window) return wall;

  // On to the pane, unless a side of the recess is nearer.
  const double du = ray.direction[along], dv = ray.direction.z();
  const double to_pane_m = recess_m / cos_wall;
  const double to_jamb_m =
      ((du > 0 ? half_window_m : -half_window_m) - from_window_middle_m) / (du == 0 ? 1e-9 : du);
  const double to_ledge_m = ((dv > 0 ? lintel_m : sill_m) - above_floor_m) / (dv == 0 ? 1e-9 : dv);
  if (to_pane_m < std::min(to_jamb_m, to_ledge_m)) {
    const auto bay = static_cast<std::uint64_t>(u_m / bay_m),
               floor = static_cast<std::uint64_t>(v_m / floor_m);
    const bool curtained = detail(object, 1024 + 64 * bay + floor) < 0.5;
    return {passage.enter_m + to_pane_m, cos_wall, curtained ? Material::plaster : Material::glass};
  }
  if (to_jamb_m < to_ledge_m) return {passage.enter_m + to_jamb_m, std::abs(du), object.material};
  return {passage.enter_m + to_ledge_m, std::abs(dv), object.material};
}

std::optional<Hit> cast_slats(const Ray& ray, const SceneObject& object, const Vector3d& half_size_m,
                              const Passage& passage) {
  constexpr double pitch_m = 0.16;
  const double u_m = ray.origin_m.x() + passage.enter_m * ray.direction.x() + half_size_m.x();
  const double slat_share = 0.45 + 0.3 * detail(object, 0);
  if (fraction(u_m / pitch_m) > slat_share) return std::nullopt;
  return Hit{passage.enter_m, std::abs(ray.direction[passage.axis]), object.material};
}

std::optional<Hit> cast_cylinder(const Ray& ray, const SceneObject& object, const Vector3d& half_size_m) {
  const Vector2d o = ray.origin_m.head<2>(), d = ray.direction.head<2>();
  const double a = d.squaredNorm(), half_b = o.dot(d);
  const double discriminant = half_b * half_b - a * (o.squaredNorm() - half_size_m.x() * half_size_m.x());
  if (discriminant < 0 || a == 0) return std::nullopt;
  const double range_m = (-half_b - std::sqrt(discriminant)) / a;
  if (range_m <= 0 || std::abs(ray.origin_m.z() + range_m * ray.direction.z()) > half_size_m.z()) {
    return std::nullopt;
  }
  const Vector2d normal = (o + range_m * d) / half_size_m.x();
  return Hit{range_m, std::abs(normal.dot(d)), object.material};
}

// Leaves fill a fixed, random share of small voxels, so the tree looks alike from sweep to sweep.
std::optional<Hit> cast_foliage(const Ray& ray, const SceneObject& object, const Vector3d& half_size_m) {
  constexpr double voxel_m = 0.2;
  const Vector3d o = ray.origin_m.cwiseQuotient(half_size_m);
  const Vector3d d = ray.direction.cwiseQuotient(half_size_m);
  const double a = d.squaredNorm(), half_b = o.dot(d);
  const double discriminant = half_b * half_b - a * (o.squaredNorm() - 1);
  if (discriminant < 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const double exit_m = (-half_b + root) / a;
  const double filled_share = 0.12 + 0.25 * detail(object, 0);
  for (double range_m = std::max((-half_b - root) / a, 0.0); range_m < exit_m; range_m += voxel_m) {
    const Vector3d p = (ray.origin_m + range_m * ray.direction) / voxel_m;
    const auto cell = [](double v) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(v + 4096));
    };
    const std::uint64_t h = mix_bits(object.salt + (cell(p.x()) << 42) + (cell(p.y()) << 21) + cell(p.z()));
    if (to_unit_interval(h) < filled_share) {
      const double leaf_m = to_unit_interval(mix_bits(h)) * voxel_m;
      return Hit{range_m + leaf_m, 0.4 + 0.6 * to_unit_interval(mix_bits(h + 1)), object.material};
    }
  }
  return std::nullopt;
}

std::optional<Hit> cast_local(const Ray& ray, const SceneObject& object, const Vector3d& half_size_m) {
  if (object.shape == Shape::cylinder) return cast_cylinder(ray, object, half_size_m);
  if (object.shape == Shape::foliage) return cast_foliage(ray, object, half_size_m);
  const std::optional<Passage> passage = pass_box(ray, half_size_m);
  if (!passage) return std::nullopt;
  if (object.shape == Shape::building) return cast_facade(ray, object, half_size_m, *passage);
  if (object.shape == Shape::slats) return cast_slats(ray, object, half_size_m, *passage);
  return Hit{passage->enter_m, std::abs(ray.direction[passage->axis]), object.material};
}

}  // namespace

std::optional<Hit> cast(const Ray& ray_world, const SceneObject& object, double age_s, double max_range_m) {
  const Vector2d offset = ray_world.origin_m.head<2>() - object.center_m - age_s * object.velocity_mps;
  const Vector2d origin = to_footprint(object, offset);
  const Vector2d direction = to_footprint(object, ray_world.direction.head<2>());
  const double z_middle_m = 0.5 * (object.z_min_m + object.z_max_m);
  const Ray ray{{origin.x(), origin.y(), ray_world.origin_m.z() - z_middle_m},
                {direction.x(), direction.y(), ray_world.direction.z()}};
  const Vector3d half_size_m(object.half_size_m.x(), object.half_size_m.y(),
                             0.5 * (object.z_max_m - object.z_min_m));
  const std::optional<Hit> hit = cast_local(ray, object, half_size_m);
  return hit && hit->range_m < max_range_m ? hit : std::nullopt;
}

}  // namespace pointreel::sim
