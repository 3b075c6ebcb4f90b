// Corrections: small steps in space for the points whose ray misses them by more than the bound allows.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

struct Correction {
  std::uint32_t index = 0;  // of the point, in the order that the caller counts in
  std::array<std::int32_t, 3> steps{};
};

// Steps are edges of cubes that fit the bound with room for the rounding to float32.
class CorrectionSteps {
 public:
  explicit CorrectionSteps(double max_error_m) : max_error_m_(max_error_m), edge_m_(1.1 * max_error_m) {}

  // Coordinates up to here are fine enough in float32: half a cube's diagonal is 0.953 bounds, the rounding
  // of three coordinates (half a unit in the last place each) takes less than 0.045 bounds.
  double reach_m() const;

  // The correction that brings `decoded` within the bound of `original`, for points within reach.
  Correction between(std::uint32_t index, const Point3f& decoded, const Point3f& original) const;
  Point3f apply(const Point3f& decoded, const Correction& correction) const;

 private:
  double max_error_m_, edge_m_;
};

inline double distance_m(const Point3f& a, const Point3f& b) {
  const double dx = static_cast<double>(a.x) - b.x;
  const double dy = static_cast<double>(a.y) - b.y;
  const double dz = static_cast<double>(a.z) - b.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

// Indices ascending and below `points`.
std::vector<std::uint8_t> encode_corrections(std::span<const Correction> corrections);
Result<std::vector<Correction>> decode_corrections(std::span<const std::uint8_t> bytes, std::size_t points);

}  // namespace pointreel
