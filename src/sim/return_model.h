// What the receiver makes of a hit: a range and an intensity, or nothing.
#pragma once

#include <optional>

#include "pointreel/simulator.h"
#include "sim/random.h"
#include "sim/ray_cast.h"

namespace pointreel::sim {

struct Return {
  double range_m;    // on the sensor's 2 mm lattice
  double intensity;  // 0.00 to 0.99 by 0.01
};

std::optional<Return> receive(const Hit& hit, const SimulatorOptions& options, Random& random);

}  // namespace pointreel::sim
