#include "sim/scene.h"

#include "sim/random.h"

namespace pointreel::sim {

Scene::Scene(const Road& road, const VehicleMotion& motion, double traffic_speed_mps, double max_range_m,
             std::uint64_t seed)
    : road_(road),
      motion_(motion),
      max_range_m_(max_range_m),
      street_(road, combine(seed, 1)),
      traffic_(road, motion, traffic_speed_mps, combine(seed, 2)) {}

void Scene::prepare(double begin_s, double end_s) {
  // Objects are placed by their middle: a long one may reach further than its block.
  constexpr double margin_m = 15;
  const double reach_m = max_range_m_ + margin_m;
  const double x_m = motion_.road_position_m(begin_s);
  street_.cover(x_m - reach_m, x_m + reach_m);
  objects_.clear();
  std::vector<Crossing> crossings;
  for (const StreetBlock& block : street_.blocks()) {
    objects_.insert(objects_.end(), block.objects.begin(), block.objects.end());
    crossings.insert(crossings.end(), block.crossings.begin(), block.crossings.end());
  }
  traffic_.append_cars(begin_s, end_s, reach_m, objects_);
  index_.build(objects_, motion_.state(begin_s).T_world_sensor, motion_.state(end_s).T_world_sensor,
               end_s - begin_s, max_range_m_);
  ground_.emplace(road_, crossings, x_m - reach_m, x_m + reach_m);
}

std::optional<Hit> Scene::cast(const Ray& ray, double azimuth_world_rad, double age_s) const {
  std::optional<Hit> nearest = ground_->cast(ray, max_range_m_);
  const double horizontal = ray.direction.head<2>().norm();
  const double slope = ray.direction.z() / horizontal;
  double limit_m = nearest ? nearest->range_m : max_range_m_;
  for (const SectorIndex::Candidate& candidate : index_.candidates(azimuth_world_rad)) {
    if (candidate.min_distance_m > limit_m * horizontal) break;
    if (slope < candidate.min_slope || slope > candidate.max_slope) continue;
    if (const auto hit = sim::cast(ray, objects_[candidate.object], age_s, limit_m)) {
      nearest = hit;
      limit_m = hit->range_m;
    }
  }
  return nearest;
}

}  // namespace pointreel::sim
