#include "codec/verification.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/simd_loops.h"
#include "sensor/ray_table.h"

namespace pointreel {
namespace {

// Tells from the measured ranges which points are surely within the bound, without their decoded positions.
// Of sweeps as measured.
//
// A point is `deviation` off its ray, across and up or down, and was decoded `away` from there along the ray:
// it is off by the hypotenuse, but for
//   deviation^2 / rho            the arc between ray and point, whose chord is shorter and bent
//   deviation h / rho            the ray's turn by the side offset h: along it, a point moves across, too,
//   away (h / rho)^2             and farther than its range does
// the first two once more since deviations are measured at the point's own rho, and for roundings, which turn
// points by less than 2e-6.
class QuickCheck {
 public:
  static constexpr std::size_t kBlock = 256;

  QuickCheck(const SensorModel& model, const GriddedSweep& sweep, std::span<const float> range_of_cell_m,
             double max_error_m)
      : sweep_(sweep), range_of_cell_m_(range_of_cell_m), max_error_m_(static_cast<float>(max_error_m)) {
    for (const RowModel& row : model.rows) {
      side_m_ = std::max(side_m_, static_cast<float>(std::fabs(row.side_offset_m)));
      offset_m_ = std::max(offset_m_, static_cast<float>(std::fabs(row.offset_m)));
      range_per_rho_ = std::max(range_per_rho_, static_cast<float>(std::hypot(1, row.slope)));
    }
  }

  // Of `count` points, at most kBlock: 1 for those that are to be looked at. False if there are none.
  POINTREEL_SIMD_LOOPS bool find_unsure(std::size_t first, std::size_t count, std::int32_t* unsure) const {
    constexpr float kRounding = 3e-6F, kLeastM = 1e-3F;
    const std::int32_t* cells = &sweep_.cell_of_point[first];
    const float* ranges_m = &sweep_.range_m[first];
    const float* deviations_m = &sweep_.deviation_m[first];
    const float* of_cell_m = range_of_cell_m_.data();
    float decoded_m[kBlock];
    for (std::size_t k = 0; k < count; ++k) decoded_m[k] = of_cell_m[cells[k] < 0 ? 0 : cells[k]];
    int any = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const float away_m = std::fabs(decoded_m[k] - ranges_m[k]), deviation_m = deviations_m[k];
      const float nearer_m = decoded_m[k] < ranges_m[k] ? decoded_m[k] : ranges_m[k];
      const float per_rho_m = range_per_rho_ / (nearer_m > kLeastM ? nearer_m : kLeastM);
      const float slack_m =
          (2 * deviation_m * (side_m_ + deviation_m) + away_m * (side_m_ * side_m_) * per_rho_m) * per_rho_m +
          kRounding * (ranges_m[k] + offset_m_ + max_error_m_);
      const float left_m = max_error_m_ - slack_m > 0 ? max_error_m_ - slack_m : 0.0F;
      const bool sure = deviation_m * deviation_m + away_m * away_m < left_m * left_m;
      unsure[k] = cells[k] < 0 || sure ? 0 : 1;
      any |= unsure[k];
    }
    return any != 0;
  }

 private:
  const GriddedSweep& sweep_;
  std::span<const float> range_of_cell_m_;
  float max_error_m_;
  float side_m_ = 0, offset_m_ = 0, range_per_rho_ = 1;  // of all rows, the largest
};

// Looks at all cells of a row.
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

// Cells, by piece of work.
using MissedCells = std::vector<std::vector<std::uint32_t>>;

MissedCells missed_of_rows(const RayTable& rays, const PointCloud& cloud, const GriddedSweep& sweep,
                           std::span<const float> range_of_cell_m, double max_error_m, int threads) {
  const std::size_t pieces = std::min(rays.row_count(), std::size_t{16});
  MissedCells missed(pieces);
  parallel_for(pieces, threads, [&](std::size_t piece) {
    RowCheck check(rays, cloud, range_of_cell_m, sweep.point_of_cell, max_error_m);
    for (std::size_t row = piece; row < rays.row_count(); row += pieces)
      check.find_missed(row, missed[piece]);
  });
  return missed;
}

MissedCells missed_of_points(const SensorModel& model, const RayTable& rays, const PointCloud& cloud,
                             const GriddedSweep& sweep, std::span<const float> range_of_cell_m,
                             double max_error_m, int threads) {
  const QuickCheck quick(model, sweep, range_of_cell_m, max_error_m);
  const std::size_t columns = rays.column_count();
  MissedCells missed((cloud.size() + kPiecePoints - 1) / kPiecePoints);
  for_each_piece(cloud.size(), threads, [&](std::size_t piece, std::size_t piece_first, std::size_t last) {
    std::int32_t unsure[QuickCheck::kBlock];
    for (std::size_t first = piece_first; first < last; first += QuickCheck::kBlock) {
      const std::size_t count = std::min(QuickCheck::kBlock, last - first);
      if (!quick.find_unsure(first, count, unsure)) continue;
      for (std::size_t k = 0; k < count; ++k) {
        if (unsure[k] == 0) continue;
        const auto cell = static_cast<std::uint32_t>(sweep.cell_of_point[first + k]);
        const Point3f decoded = rays.position(cell / columns, cell % columns, range_of_cell_m[cell]);
        if (distance_m(decoded, cloud.positions[first + k]) > max_error_m) missed[piece].push_back(cell);
      }
    }
  });
  return missed;
}

}  // namespace

std::vector<Correction> find_corrections(const SensorModel& model, const PointCloud& cloud,
                                         const GriddedSweep& sweep, std::span<const float> range_of_cell_m,
                                         std::span<const std::uint32_t> cells, double max_error_m,
                                         int threads) {
  const std::size_t columns = sweep.grid.column_count();
  if (cloud.size() == 0 || columns == 0) return {};
  const RayTable rays(model, sweep.grid);
  const auto missed =
      sweep.grid.motion ? missed_of_rows(rays, cloud, sweep, range_of_cell_m, max_error_m, threads)
                        : missed_of_points(model, rays, cloud, sweep, range_of_cell_m, max_error_m, threads);
  std::vector<std::uint8_t> is_missed;
  for (const auto& of_piece : missed) {
    if (!of_piece.empty()) is_missed.resize(range_of_cell_m.size(), 0);
    for (const std::uint32_t cell : of_piece) is_missed[cell] = 1;
  }
  std::vector<Correction> corrections;
  if (is_missed.empty()) return corrections;
  const CorrectionSteps steps(max_error_m);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t cell = cells[i];
    if (is_missed[cell] == 0) continue;
    corrections.push_back(steps.between(static_cast<std::uint32_t>(i),
                                        rays.position(cell / columns, cell % columns, range_of_cell_m[cell]),
                                        cloud.positions[sweep.point_of_cell[cell]]));
  }
  return corrections;
}

}  // namespace pointreel
