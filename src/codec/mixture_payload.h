// What a payload of method `mixture` starts with: how the sweep is coded.
#pragma once

#include <cstdint>

namespace pointreel {

enum class SweepCoding : std::uint8_t {
  scattered = 0,      // an octree; the order of the points is not kept
  gridded = 1,        // on the grid of the sensor model that the reference frame brought
  gridded_model = 2,  // on the grid of the sensor model that comes first in this payload
  predicted = 3,      // on the grid of the group's sensor model, from the ranges of the reference frame
};

}  // namespace pointreel
