#include "scatter/lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pointreel {

int Lattice::shrink_for(std::span<const Point3f> points, double max_error_m) {
  std::vector<float> largest;
  for (const Point3f& p : points) {
    if (is_finite(p)) largest.push_back(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}));
  }
  if (largest.empty()) return kMaxShrink;
  const auto nearly_all = largest.begin() + static_cast<std::ptrdiff_t>((largest.size() - 1) * 99 / 100);
  std::nth_element(largest.begin(), nearly_all, largest.end());
  // Half a unit in the last place per coordinate, as a share of the bound; a float has 24 bits.
  int exponent = 0;
  std::frexp(static_cast<double>(*nearly_all) + max_error_m, &exponent);
  const double share = std::sqrt(3.0) / 2 * std::ldexp(1.0, exponent - 24) / max_error_m;
  return std::clamp(share > 0.5 ? 1 : static_cast<int>(std::floor(-std::log2(share))), 1, kMaxShrink);
}

std::optional<LatticeCell> Lattice::cell_of(const Point3f& point) const {
  const std::array<float, 3> original = {point.x, point.y, point.z};
  LatticeCell cell;
  double squared_m2 = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double index = std::floor(static_cast<double>(original[axis]) / edge_m_ + 0.5);
    if (!(std::fabs(index) < kMaxIndex)) return std::nullopt;
    cell[axis] = static_cast<std::int32_t>(index);
    const double off_m = static_cast<double>(coordinate(cell[axis])) - static_cast<double>(original[axis]);
    squared_m2 += off_m * off_m;
  }
  if (!(std::sqrt(squared_m2) <= max_error_m_)) return std::nullopt;
  return cell;
}

RawPoint raw_bits(const Point3f& point) {
  return {std::bit_cast<std::uint32_t>(point.x), std::bit_cast<std::uint32_t>(point.y),
          std::bit_cast<std::uint32_t>(point.z)};
}

Point3f point_from(const RawPoint& raw) {
  return {std::bit_cast<float>(raw[0]), std::bit_cast<float>(raw[1]), std::bit_cast<float>(raw[2])};
}

}  // namespace pointreel
