// Points without any structure, under a 3-D error bound: an octree over a cubic lattice. Their order is not
// kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

struct ScatteredPoints {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint32_t> order;  // order[i]: index in the input of the i-th decoded point
};

// Every decoded float32 position lies within max_error_m (> 0, finite) of its own original, in 3-D; the
// encoder verifies that. Equal points stay as many as they were. Points that the lattice cannot hold (float32
// is coarser than the bound out there, or the coordinates are not finite) come back to the bit.
ScatteredPoints encode_scattered(std::span<const Point3f> points, double max_error_m);

// Fails rather than give more than `points_limit` points.
Result<std::vector<Point3f>> decode_scattered(std::span<const std::uint8_t> bytes, double max_error_m,
                                              std::size_t points_limit);

}  // namespace pointreel
