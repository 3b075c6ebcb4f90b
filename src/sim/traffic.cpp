#include "sim/traffic.h"

#include <cmath>
#include <numbers>

#include "sim/car.h"
#include "sim/random.h"

namespace pointreel::sim {

void Traffic::append_cars(double begin_s, double end_s, double reach_m,
                          std::vector<SceneObject>& objects) const {
  const double duration_s = end_s - begin_s;

  // Same lane: they keep their distance to us, give or take.
  for (const double side : {1.0, -1.0}) {
    const std::uint64_t salt = combine(seed_, side > 0 ? 1 : 2);
    const double gap_m = 14 + 12 * to_unit_interval(salt);
    const auto x_at = [&](double time_s) {
      return motion_.road_position_m(time_s) + side * (gap_m + 3 * std::sin(0.21 * time_s));
    };
    append_car_between(x_at(begin_s), x_at(end_s), duration_s, -lane_centre_m, salt, objects);
  }

  // Oncoming: car k starts near k * spacing.
  constexpr double spacing_m = 55;
  const double middle_m = motion_.road_position_m(begin_s);
  const double driven_m = oncoming_speed_mps_ * begin_s;
  const auto first = static_cast<std::int64_t>(std::floor((middle_m - reach_m + driven_m) / spacing_m));
  const auto last = static_cast<std::int64_t>(std::ceil((middle_m + reach_m + driven_m) / spacing_m));
  for (std::int64_t k = first; k <= last; ++k) {
    const std::uint64_t salt = combine(seed_, static_cast<std::uint64_t>(k) + (1ull << 32));
    const double x_m = spacing_m * (static_cast<double>(k) + 0.7 * to_unit_interval(salt)) - driven_m;
    append_car_between(x_m, x_m - oncoming_speed_mps_ * duration_s, duration_s, lane_centre_m, salt, objects);
  }
}

void Traffic::append_car_between(double begin_x_m, double end_x_m, double duration_s, double lane_m,
                                 std::uint64_t salt, std::vector<SceneObject>& objects) const {
  const Eigen::Vector2d begin = road_.beside(begin_x_m, lane_m), end = road_.beside(end_x_m, lane_m);
  const double yaw_rad = road_.heading_rad(begin_x_m) + (lane_m > 0 ? std::numbers::pi : 0);
  append_car({begin, yaw_rad, (end - begin) / duration_s}, salt, objects);
}

}  // namespace pointreel::sim
