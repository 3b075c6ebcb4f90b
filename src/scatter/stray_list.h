// A usually short list of points with their places in the output's order: those that no sensor grid explains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

struct Stray {
  std::uint32_t index = 0;  // in the output's order
  Point3f position;
  friend bool operator==(const Stray&, const Stray&) = default;
};

// `strays` by ascending index, no index twice. Decoded positions lie within max_error_m (> 0, finite) of the
// originals, in 3-D; those the lattice cannot hold, and any that are not finite, come back to the bit.
std::vector<std::uint8_t> encode_strays(std::span<const Stray> strays, double max_error_m);

// Indices come back ascending and below `points_limit`, or it fails.
Result<std::vector<Stray>> decode_strays(std::span<const std::uint8_t> bytes, double max_error_m,
                                         std::size_t points_limit);

}  // namespace pointreel
