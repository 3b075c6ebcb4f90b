#include "planes/plane_levels.h"

#include <algorithm>

namespace pointreel {
namespace {

// Of n's components, for a plane at distance rho: drho = rho^2 dn.
double tilt_step(double rho_m, double step_m, double half_extent) {
  return step_m / (rho_m * rho_m * half_extent);
}

std::int32_t rounded(double level) {
  constexpr double kMost = kMostPlaneLevel;
  level = level < kMost ? level : kMost;
  level = level > -kMost ? level : -kMost;  // NaN, too
  return static_cast<std::int32_t>(level + (level < 0 ? -0.5 : 0.5));
}

}  // namespace

Plane plane_from_levels(const PlaneFrame& frame, const PlaneLevels& levels, double step_m) {
  const auto& [cosine, sine, slope, offset_m] = frame.at;
  const double rho_m = levels[0] * step_m;
  const double across = levels[1] * tilt_step(rho_m, step_m, frame.half_width_rad);
  const double up = levels[2] * tilt_step(rho_m, step_m, frame.half_height);
  const double ahead = (1 - up * offset_m) / rho_m - up * slope;
  return {ahead * cosine - across * sine, ahead * sine + across * cosine, up};
}

std::optional<std::int32_t> distance_level(const PlaneFrame& frame, const Plane& plane, double step_m) {
  constexpr double kFarthestM = 1000;
  const auto& [cosine, sine, slope, offset_m] = frame.at;
  const double rho_m = (1 - plane.z * offset_m) / ((plane.x * cosine + plane.y * sine) + plane.z * slope);
  if (!(rho_m > step_m && rho_m < kFarthestM)) return std::nullopt;
  return std::clamp(rounded(rho_m / step_m), 1, kMostPlaneLevel);
}

Plane plane_at_distance(const PlaneFrame& frame, const Plane& plane, std::int32_t level, double step_m) {
  const auto& [cosine, sine, slope, offset_m] = frame.at;
  const double rho_m = level * step_m;
  const double scale =
      1 / (rho_m * ((plane.x * cosine + plane.y * sine) + plane.z * slope) + plane.z * offset_m);
  return {plane.x * scale, plane.y * scale, plane.z * scale};
}

std::optional<PlaneLevels> levels_of_plane(const PlaneFrame& frame, const Plane& plane, double step_m) {
  const auto level = distance_level(frame, plane, step_m);
  if (!level) return std::nullopt;
  const double cosine = frame.at.cos, sine = frame.at.sin;
  const double coarse_m = *level * step_m;
  return PlaneLevels{
      *level,
      rounded((plane.y * cosine - plane.x * sine) / tilt_step(coarse_m, step_m, frame.half_width_rad)),
      rounded(plane.z / tilt_step(coarse_m, step_m, frame.half_height))};
}

}  // namespace pointreel
