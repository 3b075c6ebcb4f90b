// What stands beside one block of the street.
#include <numbers>

#include "sim/car.h"
#include "sim/random.h"
#include "sim/street.h"

namespace pointreel::sim {
namespace {

enum class Side { left = 1, right = -1 };

class BlockBuilder {
 public:
  BlockBuilder(const Road& road, std::uint64_t seed, std::int64_t index)
      : road_(road),
        random_(combine(seed, static_cast<std::uint64_t>(index))),
        end_x_m_(static_cast<double>(index + 1) * street_block_length_m),
        block_{index, {}, {}} {
    const double start_x_m = end_x_m_ - street_block_length_m;
    begin_x_m_ = start_x_m;
    if (random_.chance(0.5)) {
      begin_x_m_ += random_.uniform(9, 12);
      block_.crossings.push_back({start_x_m, begin_x_m_});
    }
  }

  StreetBlock build() {
    for (const Side side : {Side::left, Side::right}) {
      side_ = side;
      add_curbside();
      const double style = random_.uniform();
      if (style < 0.4) {
        add_terrace();
      } else if (style < 0.8) {
        add_gardens();
      } else {
        add_park();
      }
      add_backdrop();
      if (!block_.crossings.empty()) add_side_street();
    }
    return std::move(block_);
  }

 private:
  // `lateral_m` counts away from the road on the current side; size is (along, across) the road.
  void add(Shape shape, Material material, double x_m, double lateral_m, Eigen::Vector2d size_m,
           double z_min_m, double z_max_m) {
    const double yaw = road_.heading_rad(x_m);
    block_.objects.push_back({shape, material, random_.bits(),
                              road_.beside(x_m, lateral_m * static_cast<double>(side_)), size_m / 2,
                              std::cos(yaw), std::sin(yaw), z_min_m, z_max_m});
  }

  void add_pole(double x_m, double lateral_m) {
    add(Shape::cylinder, Material::metal, x_m, lateral_m, {0.16, 0.16}, 0, random_.uniform(4, 8));
    if (random_.chance(0.4)) {  // a sign
      const double z_m = random_.uniform(2, 2.6);
      add(Shape::box, Material::metal, x_m, lateral_m, {0.03, 0.6}, z_m, z_m + 0.6);
    }
  }

  void add_tree(double x_m, double lateral_m) {
    const double trunk_m = random_.uniform(1.8, 2.8), foliage_m = random_.uniform(2.5, 5);
    const double trunk_width_m = random_.uniform(0.2, 0.5);
    add(Shape::cylinder, Material::wood, x_m, lateral_m, {trunk_width_m, trunk_width_m}, 0,
        trunk_m + foliage_m / 2);
    add(Shape::foliage, Material::leaves, x_m, lateral_m, {foliage_m, foliage_m}, trunk_m,
        trunk_m + foliage_m * random_.uniform(0.9, 1.4));
  }

  void add_bush(double x_m, double lateral_m) {
    const double width_m = random_.uniform(0.8, 2.2);
    // Half of the ellipsoid is in the ground.
    const double height_m = random_.uniform(0.6, 1.6);
    add(Shape::foliage, Material::leaves, x_m, lateral_m, {width_m, width_m}, -height_m, height_m);
  }

  void add_building(double x_m, double front_m, Eigen::Vector2d size_m, double height_m) {
    const Material material = random_.chance(0.6) ? Material::plaster : Material::brick;
    add(Shape::building, material, x_m, front_m + size_m.y() / 2, size_m, 0, height_m);
    for (double bay_m = -size_m.x() / 2 + 2; bay_m < size_m.x() / 2 - 2; bay_m += random_.uniform(3, 7)) {
      if (random_.chance(0.5)) continue;
      const double depth_m = random_.uniform(0.3, 1.1), z_min_m = random_.chance(0.5) ? 0 : 2.8;
      add(Shape::box, material, x_m + bay_m, front_m - depth_m / 2, {random_.uniform(1.2, 2.6), depth_m},
          z_min_m, z_min_m + random_.uniform(1, height_m - 1));
    }
  }

  // Wall, fence or hedge along the road.
  void add_boundary(double begin_x_m, double end_x_m, double lateral_m) {
    const double middle_m = (begin_x_m + end_x_m) / 2, length_m = end_x_m - begin_x_m;
    const double kind = random_.uniform(), height_m = random_.uniform(0.7, 1.9);
    if (kind < 0.3) {
      add(Shape::box, Material::brick, middle_m, lateral_m, {length_m, 0.25}, 0, height_m);
    } else if (kind < 0.65) {
      add(Shape::slats, Material::wood, middle_m, lateral_m, {length_m, 0.04}, 0.15, height_m);
    } else {
      for (double x_m = begin_x_m; x_m < end_x_m; x_m += 1.1) {
        add(Shape::foliage, Material::leaves, x_m, lateral_m, {1.8, 1.0}, -height_m, height_m);
      }
    }
  }

  // Parked cars, trees and poles between road and sidewalk.
  void add_curbside() {
    const double occupancy = random_.uniform(0.1, 0.8);
    for (double x_m = begin_x_m_ + 5; x_m < end_x_m_ - 5; x_m += random_.uniform(5.4, 6.4)) {
      if (!random_.chance(occupancy)) continue;
      const double side = static_cast<double>(side_), yaw = road_.heading_rad(x_m);
      append_car({road_.beside(x_m, side * (parking_centre_m + random_.uniform(-0.15, 0.1))),
                  yaw + (side_ == Side::left ? std::numbers::pi : 0) + random_.uniform(-0.03, 0.03)},
                 random_.bits(), block_.objects);
    }
    const double tree_share = random_.uniform(0, 0.6);
    for (double x_m = begin_x_m_ + 3; x_m < end_x_m_ - 2; x_m += random_.uniform(7, 11)) {
      const double draw = random_.uniform();
      if (draw < tree_share) {
        add_tree(x_m, curb_lateral_m + 0.9);
      } else if (draw < tree_share + 0.25) {
        add_pole(x_m, curb_lateral_m + 0.5);
      }
    }
  }

  // Town houses in a row.
  void add_terrace() {
    for (double x_m = begin_x_m_; x_m < end_x_m_ - 6;) {
      const double width_m = std::min(random_.uniform(9, 20), end_x_m_ - x_m);
      add_building(x_m + width_m / 2, sidewalk_end_m + random_.uniform(0.6, 2.2), {width_m, 12},
                   random_.uniform(7, 17));
      x_m += width_m;
      if (random_.chance(0.3)) {
        const double gap_m = random_.uniform(3, 6);
        add_boundary(x_m, x_m + gap_m, sidewalk_end_m + 2);
        x_m += gap_m;
      }
    }
  }

  // Houses set back behind front gardens.
  void add_gardens() {
    for (double x_m = begin_x_m_; x_m < end_x_m_ - 10;) {
      const double lot_m = std::min(random_.uniform(14, 22), end_x_m_ - x_m);
      const double driveway_m = 3;
      add_boundary(x_m, x_m + lot_m - driveway_m, sidewalk_end_m + 0.3);
      const double front_m = sidewalk_end_m + random_.uniform(4, 9);
      add_building(x_m + lot_m / 2 - 1, front_m, {lot_m * random_.uniform(0.5, 0.75), 9},
                   random_.uniform(4.5, 9));
      if (random_.chance(0.6)) add_tree(x_m + random_.uniform(1, lot_m - 4), sidewalk_end_m + 2.6);
      for (int i = 0; i < 3; ++i)
        add_bush(x_m + random_.uniform(0, lot_m - 4), front_m - random_.uniform(0.6, 3));
      x_m += lot_m;
    }
  }

  void add_park() {
    if (random_.chance(0.4)) add_boundary(begin_x_m_ + 1, end_x_m_ - 1, sidewalk_end_m + 0.3);
    for (double x_m = begin_x_m_ + 2; x_m < end_x_m_; x_m += random_.uniform(2, 5)) {
      add_tree(x_m, random_.uniform(sidewalk_end_m + 3, 34));
      if (random_.chance(0.6)) add_bush(x_m, random_.uniform(sidewalk_end_m + 1.5, 25));
    }
  }

  // Larger buildings and trees that show through the gaps.
  void add_backdrop() {
    for (double x_m = begin_x_m_; x_m < end_x_m_ - 12; x_m += random_.uniform(3, 10)) {
      const double width_m = std::min(random_.uniform(12, 28), end_x_m_ - x_m);
      add_building(x_m + width_m / 2, random_.uniform(36, 44), {width_m, 14}, random_.uniform(8, 18));
      x_m += width_m;
      add_tree(x_m, random_.uniform(28, 36));
    }
  }

  void add_side_street() {
    const Crossing& crossing = block_.crossings.front();
    add_pole(crossing.end_x_m + 0.5, curb_lateral_m + 0.6);
    const double x_m = crossing.begin_x_m + random_.uniform(1.2, 1.6);
    for (double lateral_m = 14; lateral_m < 34; lateral_m += random_.uniform(5.5, 7)) {
      if (!random_.chance(0.5)) continue;
      append_car({road_.beside(x_m, lateral_m * static_cast<double>(side_)),
                  road_.heading_rad(x_m) + std::numbers::pi / 2},
                 random_.bits(), block_.objects);
    }
    // The side street ends at a wall of buildings now and then.
    if (random_.chance(0.5)) {
      add_building((crossing.begin_x_m + crossing.end_x_m) / 2, random_.uniform(60, 85), {22, 12},
                   random_.uniform(8, 15));
    }
  }

  const Road& road_;
  Random random_;
  double begin_x_m_;  // after the crossing, if there is one
  double end_x_m_;
  Side side_ = Side::left;
  StreetBlock block_;
};

}  // namespace

StreetBlock make_street_block(const Road& road, std::uint64_t seed, std::int64_t index) {
  return BlockBuilder(road, seed, index).build();
}

}  // namespace pointreel::sim
