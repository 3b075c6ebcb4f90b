// ReferenceImage: what an earlier sweep says about the cells of this one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointreel {

// What it says about whether there is a return, one bit each.
enum HitReference : std::uint8_t {
  kWarpedHit = 1,     // the warped reference has a return here
  kWarpedFilled = 2,  // a hole of the warped reference, filled from its neighbours; not with kWarpedHit
  kPreviousHit = 4,   // the reference had a return in this cell, not warped: the car's own shadow stays
};

// Of the size of the sweep's own GridImage.
struct ReferenceImage {
  int rows = 0;
  int columns = 0;
  std::vector<float> range_m;      // row-major; 0: nothing is known
  std::vector<std::uint8_t> hits;  // HitReference bits

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

}  // namespace pointreel
