// The cubic lattice that positions under a 3-D bound are rounded to.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "entropy/plain_bits.h"
#include "pointreel/point_cloud.h"

namespace pointreel {

using LatticeCell = std::array<std::int32_t, 3>;

class Lattice {
 public:
  static constexpr int kMaxShrink = 31;
  static constexpr std::int32_t kMaxIndex = 1 << 30;

  // Edges of 2 max_error_m / sqrt(3) would leave nothing for the rounding to float32: they are shorter by
  // 2^-shrink (1 to kMaxShrink) of that.
  Lattice(double max_error_m, int shrink)
      : max_error_m_(max_error_m),
        edge_m_(max_error_m * 1.1547005383792515 *
                (1 - 1.0 / static_cast<double>(std::uint64_t{1} << shrink))) {}

  // The least shrinking that lets nearly all the points pass; far outliers do not count.
  static int shrink_for(std::span<const Point3f> points, double max_error_m);

  // Nothing when the decoded position is not within the bound.
  std::optional<LatticeCell> cell_of(const Point3f& point) const;

  Point3f position(const LatticeCell& cell) const {
    return {coordinate(cell[0]), coordinate(cell[1]), coordinate(cell[2])};
  }

 private:
  float coordinate(std::int32_t index) const {
    return static_cast<float>(static_cast<double>(index) * edge_m_);
  }

  double max_error_m_, edge_m_;
};

using RawPoint = std::array<std::uint32_t, 3>;  // the bits of a position
RawPoint raw_bits(const Point3f& point);
Point3f point_from(const RawPoint& raw);

template <class Coder>
void code_raw_point(Coder& coder, RawPoint& raw) {
  for (std::uint32_t& word : raw) word = static_cast<std::uint32_t>(code_plain_bits(coder, word, 32));
}

}  // namespace pointreel
