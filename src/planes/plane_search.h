// find_planes: which tiles of a sweep lie on planes.
#pragma once

#include <span>

#include "planes/moved_planes.h"
#include "planes/plane_tiles.h"

namespace pointreel {

// What the planes are to reproduce. By cell of the image, row-major.
struct PlaneTask {
  const SensorRays& rays;
  std::span<const float> range_m;      // 0: no return, any plane will do
  std::span<const float> tolerance_m;  // of the range
  double step_m;                       // of the planes (PlaneLevels)
  const MovedPlanes& earlier;          // of an earlier sweep
};

// Every cell of a tile that is given a plane meets that plane, as decoded, within its tolerance but for the
// rounding of floats.
PlaneTiles find_planes(const PlaneTask& task);

}  // namespace pointreel
