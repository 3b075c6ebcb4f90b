// PlaneTiles to bytes and back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planes/moved_planes.h"
#include "planes/plane_tiles.h"
#include "pointreel/result.h"

namespace pointreel {

// `step_m`: of the planes (PlaneLevels). `earlier`: what is known from an earlier sweep.
std::vector<std::uint8_t> encode_plane_tiles(const SensorRays& rays, double step_m,
                                             const MovedPlanes& earlier, const PlaneTiles& planes);

// Error: truncated.
Result<PlaneTiles> decode_plane_tiles(const SensorRays& rays, double step_m, const MovedPlanes& earlier,
                                      std::span<const std::uint8_t> bytes);

}  // namespace pointreel
