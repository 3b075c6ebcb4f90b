#include "codec/verification.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"

namespace pointreel {
namespace {

// Looks at the cells of rows.
class RowCheck {
 public:
  RowCheck(const RayTable& rays, const PointCloud& cloud, std::span<const float> range_of_cell_m,
           std::span<const std::uint32_t> point_of_cell, double max_error_m)
      : rays_(rays),
        cloud_(cloud),
        range_of_cell_m_(range_of_cell_m),
        point_of_cell_(point_of_cell),
        max_error_m_(max_error_m),
        surely_within_m2_(static_cast<float>(kSureShare * max_error_m * max_error_m)),
        positions_(rays.column_count()) {}

  // Cells whose points miss the bound.
  void find_missed(std::size_t row, std::vector<std::uint32_t>& missed) {
    const std::size_t columns = positions_.size();
    const auto ranges_m = range_of_cell_m_.subspan(row * columns, columns);
    rays_.positions_of_row(row, ranges_m, positions_);
    // Float tells for nearly all; branches on single cells would be mispredicted.
    constexpr std::size_t kBlock = 64;
    std::uint8_t unsure[kBlock];
    for (std::size_t first = 0; first < columns; first += kBlock) {
      const std::size_t count = std::min(columns - first, kBlock);
      const std::uint32_t* points = &point_of_cell_[row * columns + first];
      unsigned any = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const bool occupied = ranges_m[first + k] > 0;
        const Point3f& original = cloud_.positions[occupied ? points[k] : 0];
        const Point3f& decoded = positions_[first + k];
        const float dx = decoded.x - original.x, dy = decoded.y - original.y, dz = decoded.z - original.z;
        const bool sure = dx * dx + dy * dy + dz * dz < surely_within_m2_;
        unsure[k] = static_cast<std::uint8_t>(occupied & !sure);
        any |= unsure[k];
      }
      if (any == 0) continue;
      for (std::size_t k = 0; k < count; ++k) {
        if (unsure[k] != 0 && distance_m(positions_[first + k], cloud_.positions[points[k]]) > max_error_m_)
          missed.push_back(static_cast<std::uint32_t>(row * columns + first + k));
      }
    }
  }

 private:
  static constexpr double kSureShare = 1 - 1e-5;  // a hundred roundings of the square

  const RayTable& rays_;
  const PointCloud& cloud_;
  std::span<const float> range_of_cell_m_;
  std::span<const std::uint32_t> point_of_cell_;
  double max_error_m_;
  float surely_within_m2_;
  std::vector<Point3f> positions_;  // of the row
};

}  // namespace

std::vector<Correction> find_corrections(const RayTable& rays, const PointCloud& cloud,
                                         std::span<const float> range_of_cell_m,
                                         std::span<const std::uint32_t> point_of_cell,
                                         std::span<const std::uint32_t> cells, double max_error_m,
                                         int threads) {
  if (cloud.size() == 0) return {};
  const std::size_t columns = rays.column_count();
  std::vector<std::vector<std::uint32_t>> missed(rays.row_count());  // cells
  const std::size_t pieces = std::min(rays.row_count(), std::size_t{16});
  parallel_for(pieces, threads, [&](std::size_t piece) {
    RowCheck check(rays, cloud, range_of_cell_m, point_of_cell, max_error_m);
    for (std::size_t row = piece; row < rays.row_count(); row += pieces) check.find_missed(row, missed[row]);
  });
  std::vector<std::uint8_t> is_missed;
  for (const auto& of_row : missed) {
    if (!of_row.empty()) is_missed.resize(range_of_cell_m.size(), 0);
    for (const std::uint32_t cell : of_row) is_missed[cell] = 1;
  }
  std::vector<Correction> corrections;
  if (is_missed.empty()) return corrections;
  const CorrectionSteps steps(max_error_m);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t cell = cells[i];
    if (is_missed[cell] == 0) continue;
    corrections.push_back(steps.between(static_cast<std::uint32_t>(i),
                                        rays.position(cell / columns, cell % columns, range_of_cell_m[cell]),
                                        cloud.positions[point_of_cell[cell]]));
  }
  return corrections;
}

}  // namespace pointreel
