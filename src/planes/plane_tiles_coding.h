// PlaneTiles to bytes and back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planes/plane_tiles.h"
#include "pointreel/result.h"

namespace pointreel {

// `step_m`: of the planes (PlaneLevels).
std::vector<std::uint8_t> encode_plane_tiles(const SensorRays& rays, double step_m, const PlaneTiles& planes);

// Error: truncated.
Result<PlaneTiles> decode_plane_tiles(const SensorRays& rays, double step_m,
                                      std::span<const std::uint8_t> bytes);

}  // namespace pointreel
