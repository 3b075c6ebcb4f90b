#include "sim/sector_index.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/turn.h"

namespace pointreel::sim {
namespace {

using Eigen::Vector2d;

// The lasers sit a little beside and above the sensor's origin, which also heaves.
constexpr double origin_radius_m = 0.05;
constexpr double origin_above_m = 0.25, origin_below_m = 0.05;
constexpr double tilt_margin_rad = 0.01;  // pitch and roll turn slanted beams sideways

struct Extent {
  double azimuth_begin_rad, azimuth_end_rad;
  double min_distance_m, max_distance_m;
};

// The object as seen while it passes from relative place `begin` to `end` (centre minus sensor).
Extent extent(const SceneObject& object, const Vector2d& begin, const Vector2d& end) {
  const double reference_rad = std::atan2(begin.y(), begin.x());
  Extent e{0, 0, 0, 0};
  for (const Vector2d& place : {begin, end}) {
    for (const Vector2d& sign : {Vector2d(-1, -1), Vector2d(-1, 1), Vector2d(1, -1), Vector2d(1, 1)}) {
      const Vector2d corner = place + to_world(object, object.half_size_m.cwiseProduct(sign));
      const double turn = std::remainder(std::atan2(corner.y(), corner.x()) - reference_rad, two_pi);
      e.azimuth_begin_rad = std::min(e.azimuth_begin_rad, turn);
      e.azimuth_end_rad = std::max(e.azimuth_end_rad, turn);
      e.max_distance_m = std::max(e.max_distance_m, corner.norm());
    }
    const Vector2d outside = to_footprint(object, place).cwiseAbs() - object.half_size_m;
    e.min_distance_m += 0.5 * outside.cwiseMax(0).norm();
  }
  // Between the two places it comes nearer than their mean by at most half the way.
  e.min_distance_m = std::max(e.min_distance_m - 0.5 * (end - begin).norm() - origin_radius_m, 0.0);
  const double margin = tilt_margin_rad + origin_radius_m / std::max(e.min_distance_m, origin_radius_m);
  e.azimuth_begin_rad += reference_rad - margin;
  e.azimuth_end_rad += reference_rad + margin;
  if (e.min_distance_m < 0.5) e.azimuth_begin_rad = 0, e.azimuth_end_rad = two_pi;  // may surround the sensor
  return e;
}

}  // namespace

void SectorIndex::build(std::span<const SceneObject> objects, const Pose& T_world_begin,
                        const Pose& T_world_end, double duration_s, double max_range_m) {
  const Vector2d begin_m = T_world_begin.translation().head<2>(), end_m = T_world_end.translation().head<2>();
  const double z_m = T_world_begin.translation().z();

  std::vector<std::pair<Candidate, Extent>> visible;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const SceneObject& o = objects[i];
    const Extent e = extent(o, o.center_m - begin_m, o.center_m + duration_s * o.velocity_mps - end_m);
    if (e.min_distance_m > max_range_m) continue;
    const double near_m = std::max(e.min_distance_m, 1e-3);
    const double rise_m = o.z_max_m - z_m + origin_below_m, fall_m = o.z_min_m - z_m - origin_above_m;
    visible.push_back({{static_cast<float>(e.min_distance_m),
                        static_cast<float>(fall_m / (fall_m < 0 ? near_m : e.max_distance_m)),
                        static_cast<float>(rise_m / (rise_m > 0 ? near_m : e.max_distance_m)), i},
                       e});
  }
  std::sort(visible.begin(), visible.end(), [](const auto& a, const auto& b) {
    return a.first.min_distance_m != b.first.min_distance_m ? a.first.min_distance_m < b.first.min_distance_m
                                                            : a.first.object < b.first.object;
  });

  for (auto& sector : sectors_) sector.clear();
  for (const auto& [candidate, e] : visible) {
    const auto first = static_cast<int>(std::floor(e.azimuth_begin_rad / two_pi * sector_count));
    const auto last = static_cast<int>(std::floor(e.azimuth_end_rad / two_pi * sector_count));
    for (int s = first; s <= std::min(last, first + sector_count - 1); ++s) {
      sectors_[static_cast<std::size_t>((s + 2 * sector_count) % sector_count)].push_back(candidate);
    }
  }
}

std::span<const SectorIndex::Candidate> SectorIndex::candidates(double azimuth_world_rad) const {
  const double turns = azimuth_world_rad / two_pi;
  const auto sector = static_cast<int>((turns - std::floor(turns)) * sector_count);
  return sectors_[static_cast<std::size_t>(std::min(sector, sector_count - 1))];
}

}  // namespace pointreel::sim
