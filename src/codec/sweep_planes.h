// SweepPlanes from what a packet says of them.
#pragma once

#include "planes/plane_tiles.h"
#include "pointreel/planes.h"

namespace pointreel {

SweepPlanes sweep_planes_of(std::uint32_t frame, const SensorRays& rays, const PlaneTiles& planes);

}  // namespace pointreel
