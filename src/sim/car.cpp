#include "sim/car.h"

#include "sim/random.h"

namespace pointreel::sim {

void append_car(const CarPlacement& placement, std::uint64_t salt, std::vector<SceneObject>& objects) {
  Random random(salt);
  const double length_m = random.uniform(3.8, 4.8), width_m = random.uniform(1.65, 1.85);
  const double height_m = random.uniform(1.4, 1.6);

  const auto add = [&](Material material, double forward_m, Eigen::Vector2d size_m, double z_min_m,
                       double z_max_m) {
    SceneObject part{Shape::box,
                     material,
                     salt,
                     placement.center_m,
                     size_m / 2,
                     std::cos(placement.yaw_rad),
                     std::sin(placement.yaw_rad),
                     z_min_m,
                     z_max_m,
                     placement.velocity_mps};
    part.center_m += to_world(part, {forward_m, 0});
    objects.push_back(part);
  };
  constexpr double wheel_m = 0.62;
  for (const double axle : {-0.31, 0.31}) {
    add(Material::rubber, axle * length_m, {wheel_m, width_m - 0.05}, 0.03, wheel_m);
  }
  if (random.chance(0.15)) {  // a van
    add(Material::paint, 0, {length_m + 0.6, width_m + 0.15}, 0.3, height_m + 0.7);
    return;
  }
  const double waist_m = random.uniform(0.82, 0.95);
  add(Material::paint, 0, {length_m, width_m}, 0.25, waist_m);
  add(Material::glass, -0.04 * length_m, {0.55 * length_m, width_m - 0.2}, waist_m, height_m - 0.1);
  add(Material::paint, -0.06 * length_m, {0.38 * length_m, width_m - 0.3}, height_m - 0.1, height_m);
}

}  // namespace pointreel::sim
