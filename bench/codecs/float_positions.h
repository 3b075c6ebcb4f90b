// Positions as the 12 bytes a point that general-purpose compressors are given.
#pragma once

#include <cstring>
#include <span>

#include "codecs/codec.h"

namespace pointreel {

static_assert(sizeof(Point3f) == 12);

inline std::span<const std::uint8_t> bytes_of(const std::vector<Point3f>& positions) {
  return {reinterpret_cast<const std::uint8_t*>(positions.data()), positions.size() * sizeof(Point3f)};
}

// A length that is no multiple of 12 loses its last, incomplete point.
inline PointCloud cloud_of_bytes(std::span<const std::uint8_t> bytes) {
  PointCloud cloud;
  cloud.positions.resize(bytes.size() / sizeof(Point3f));
  if (!cloud.positions.empty())
    std::memcpy(cloud.positions.data(), bytes.data(), cloud.positions.size() * sizeof(Point3f));
  return cloud;
}

}  // namespace pointreel
