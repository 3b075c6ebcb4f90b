// PlaneLevels: a plane on the sensor's grid as three whole numbers, in steps that all move its ranges alike.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "planes/plane_fit.h"
#include "planes/sensor_rays.h"

namespace pointreel {

// Where a plane is described: the direction of a cell, and how far to its sides the plane goes on.
struct PlaneFrame {
  SensorRays::Direction at;
  double half_width_rad;  // azimuth
  double half_height;     // slope
};

// [0] its distance rho in that direction; [1] n's component to the left of it, [2] n's upward one, which tilt
// it around a vertical and around a level axis.
using PlaneLevels = std::array<std::int32_t, 3>;

inline constexpr std::int32_t kMostPlaneLevel = 1 << 22;

// A step of [0] moves the plane by `step_m` in its direction, one of the others by as much at its sides.
Plane plane_from_levels(const PlaneFrame& frame, const PlaneLevels& levels, double step_m);

// The nearest levels; none where the plane is not met in the frame's direction.
std::optional<PlaneLevels> levels_of_plane(const PlaneFrame& frame, const Plane& plane, double step_m);

// A plane's normal at another distance in the frame's direction; none where it is not met there. The levels
// but the first are 0.
std::optional<std::int32_t> distance_level(const PlaneFrame& frame, const Plane& plane, double step_m);
Plane plane_at_distance(const PlaneFrame& frame, const Plane& plane, std::int32_t level, double step_m);

}  // namespace pointreel
