// Which planes are worth their bits: coding a plane takes more than coding a few points.
#pragma once

#include <span>

#include "planes/plane_tiles.h"

namespace pointreel {

// Takes the tiles off planes that, by estimate, take more bits than the ranges of their points would, in
// steps of `range_step_m`. `range_m`: by cell of the image.
void drop_dear_planes(std::span<const float> range_m, double range_step_m, PlaneTiles& planes);

}  // namespace pointreel
