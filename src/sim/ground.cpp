#include "sim/ground.h"

#include <algorithm>
#include <cmath>

namespace pointreel::sim {
namespace {

constexpr double station_spacing_m = 0.5;
constexpr double curb_height_m = 0.12;
constexpr double curb_width_m = 0.06;
constexpr double crown_m = 0.05;  // height of the road's middle over its edges
constexpr double sidewalk_rise_m = 0.04;
constexpr double max_height_m = curb_height_m + sidewalk_rise_m;

double profile_height_m(double lateral_m, double curb_m) {
  const double distance_m = std::abs(lateral_m);
  if (distance_m < curb_lateral_m) {
    const double share = distance_m / curb_lateral_m;
    return crown_m * (1 - share * share);
  }
  const double onto_curb = std::min((distance_m - curb_lateral_m) / curb_width_m, 1.0);
  const double onto_sidewalk =
      std::min((distance_m - curb_lateral_m) / (sidewalk_end_m - curb_lateral_m), 1.0);
  return curb_m * (onto_curb + onto_sidewalk * sidewalk_rise_m / curb_height_m);
}

}  // namespace

Ground::Ground(const Road& road, const std::vector<Crossing>& crossings, double begin_x_m, double end_x_m)
    : begin_x_m_(begin_x_m),
      stations_(static_cast<std::size_t>((end_x_m - begin_x_m) / station_spacing_m) + 2) {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const double x_m = begin_x_m + static_cast<double>(i) * station_spacing_m;
    const bool crossed = std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& c) {
      return x_m >= c.begin_x_m && x_m <= c.end_x_m;
    });
    stations_[i] = {road.y_m(x_m), std::cos(road.heading_rad(x_m)), crossed ? 0 : curb_height_m};
  }
}

Ground::Place Ground::locate(double x_m, double y_m) const {
  const double last = static_cast<double>(stations_.size()) - 1.001;
  const double position = std::clamp((x_m - begin_x_m_) / station_spacing_m, 0.0, last);
  const auto i = static_cast<std::size_t>(position);
  const double share = position - static_cast<double>(i);
  const Station& a = stations_[i];
  const Station& b = stations_[i + 1];
  return {(y_m - (a.y_m + share * (b.y_m - a.y_m))) * a.cos_heading,
          a.curb_height_m + share * (b.curb_height_m - a.curb_height_m)};
}

double Ground::height_m(double x_m, double y_m) const {
  const Place place = locate(x_m, y_m);
  return profile_height_m(place.lateral_m, place.curb_height_m);
}

Material Ground::material_at(double x_m, const Place& place) const {
  constexpr double dash_period_m = 9, dash_m = 3, half_line_m = 0.07;
  const double distance_m = std::abs(place.lateral_m);
  if (place.curb_height_m < curb_height_m / 2) return Material::asphalt;
  if (distance_m < half_line_m && std::fmod(std::abs(x_m), dash_period_m) < dash_m) return Material::marking;
  if (distance_m < curb_lateral_m) return Material::asphalt;
  return distance_m < sidewalk_end_m ? Material::paving : Material::grass;
}

std::optional<Hit> Ground::cast(const Ray& ray, double max_range_m) const {
  if (ray.direction.z() >= 0) return std::nullopt;
  const auto range_at_height = [&](double z_m) { return (z_m - ray.origin_m.z()) / ray.direction.z(); };
  const auto clearance_m = [&](double range_m) {
    const Eigen::Vector3d p = ray.origin_m + range_m * ray.direction;
    return p.z() - height_m(p.x(), p.y());
  };
  // The hit lies between the highest and the lowest ground; false position (Illinois) closes in on it.
  double near_m = range_at_height(max_height_m), far_m = range_at_height(0);
  if (near_m > max_range_m) return std::nullopt;
  double near_clearance_m = clearance_m(near_m), far_clearance_m = clearance_m(far_m);
  constexpr double tolerance_m = 2e-4;
  double range_m = near_clearance_m < tolerance_m ? near_m : far_m;
  if (near_clearance_m > tolerance_m && far_clearance_m < -tolerance_m) {
    bool was_above = false, was_below = false;
    for (int i = 0; i < 20; ++i) {
      range_m = near_m + (far_m - near_m) * near_clearance_m / (near_clearance_m - far_clearance_m);
      const double clearance = clearance_m(range_m);
      if (std::abs(clearance) < tolerance_m) break;
      if (clearance > 0) {
        near_m = range_m, near_clearance_m = clearance;
        if (was_above) far_clearance_m *= 0.5;
      } else {
        far_m = range_m, far_clearance_m = clearance;
        if (was_below) near_clearance_m *= 0.5;
      }
      was_above = clearance > 0, was_below = !was_above;
    }
  }
  if (range_m > max_range_m) return std::nullopt;
  const Eigen::Vector3d p = ray.origin_m + range_m * ray.direction;
  return Hit{range_m, -ray.direction.z(), material_at(p.x(), locate(p.x(), p.y()))};
}

}  // namespace pointreel::sim
