#include "motion/surface_patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>

namespace pointreel {
namespace {

// Cells to each side: narrow things such as posts tell best how far the sensor went.
constexpr int kHalfColumns = 2;
constexpr int kMostHalfRows = 2;
constexpr float kNearestM = 1;  // nearer is the vehicle itself
constexpr float kFarthestM = 80;
constexpr float kFlatWithinM = 0.04F;  // root mean square: noise, and rows that are not quite calibrated
constexpr float kLeastReturns = 0.7F;  // share of the patch's cells
constexpr float kRangeSpread = 0.3F;   // of the cells' ranges, from the centre's: others are other things

struct Sum {
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
  int count = 0;
  void add(const Eigen::Vector3f& p_m) {
    sum_m += p_m;
    ++count;
  }
  Eigen::Vector3f mean_m() const { return sum_m / static_cast<float>(count); }
};

// A look at a cell's four far neighbours alone, which settles most cases: the direction that a plane through
// them would face; negative: there is none.
int facing_at_first_sight(const GridRays& sweep, int row, int column, int half_rows) {
  constexpr float kBentM = 0.15F;
  const float center_m = sweep.range_m(row, column);
  if (!(center_m > kNearestM && center_m < kFarthestM)) return -1;
  const int left = sweep.wrapped(column - kHalfColumns), right = sweep.wrapped(column + kHalfColumns);
  const int above = sweep.same_direction(column, row, row - half_rows);
  const int below = sweep.same_direction(column, row, row + half_rows);
  const float left_m = sweep.range_m(row, left), right_m = sweep.range_m(row, right);
  const float above_m = sweep.range_m(row - half_rows, above),
              below_m = sweep.range_m(row + half_rows, below);
  if (!(std::min({left_m, right_m, above_m, below_m}) > kNearestM)) return -1;
  // 1/r is linear along a line on a plane.
  const float bend_per_m = 2 / center_m - 1 / left_m - 1 / right_m;
  if (!(std::fabs(bend_per_m) * center_m * center_m < kBentM)) return -1;
  const Eigen::Vector3f across = sweep.point_m(row, right) - sweep.point_m(row, left);
  const Eigen::Vector3f down = sweep.point_m(row + half_rows, below) - sweep.point_m(row - half_rows, above);
  return facing(across.cross(down).normalized());
}

// The plane through a cell's neighbours: its normal is across the two lines from the left to the right half's
// mean, and from the upper to the lower one's, which points missing here and there do not turn.
std::optional<SurfacePatch> patch_around(const GridRays& sweep, int row, int column, int half_rows) {
  const float center_range_m = sweep.range_m(row, column);
  if (!(center_range_m > kNearestM && center_range_m < kFarthestM)) return std::nullopt;
  std::array<Eigen::Vector3f, std::size_t{2 * kHalfColumns + 1} * (2 * kMostHalfRows + 1)> points_m;
  std::size_t count = 0;
  Sum left, right, above, below, all;
  for (int dr = -half_rows; dr <= half_rows; ++dr) {
    const int middle = sweep.same_direction(column, row, row + dr);
    for (int dc = -kHalfColumns; dc <= kHalfColumns; ++dc) {
      const int c = sweep.wrapped(middle + dc);
      const float range_m = sweep.range_m(row + dr, c);
      if (!(std::fabs(range_m - center_range_m) < kRangeSpread * center_range_m)) continue;
      const Eigen::Vector3f p_m = sweep.point_m(row + dr, c);
      points_m[count++] = p_m;
      all.add(p_m);
      if (dc != 0) (dc < 0 ? left : right).add(p_m);
      if (dr != 0) (dr < 0 ? above : below).add(p_m);
    }
  }
  const int cells = (2 * half_rows + 1) * (2 * kHalfColumns + 1);
  if (static_cast<float>(count) < kLeastReturns * static_cast<float>(cells)) return std::nullopt;
  if (left.count == 0 || right.count == 0 || above.count == 0 || below.count == 0) return std::nullopt;
  const Eigen::Vector3f across = (right.mean_m() - left.mean_m()).cross(below.mean_m() - above.mean_m());
  const float length = across.norm();
  if (!(length > 1e-9F)) return std::nullopt;
  SurfacePatch patch{all.mean_m(), across / length};
  float squares_m2 = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float away_m = patch.normal.dot(points_m[i] - patch.center_m);
    squares_m2 += away_m * away_m;
  }
  if (!(squares_m2 < kFlatWithinM * kFlatWithinM * static_cast<float>(count))) return std::nullopt;
  return patch;
}

}  // namespace

std::vector<SurfacePatch> find_surface_patches(const GridRays& sweep, int most) {
  const int half_rows = std::clamp(sweep.row_count() / 24, 1, kMostHalfRows);
  const std::int64_t rows = sweep.row_count() - std::int64_t{2} * half_rows, columns = sweep.column_count();
  std::vector<SurfacePatch> patches;
  if (rows < 1 || columns < std::int64_t{4} * kHalfColumns || most < 1) return patches;
  // A step of the golden section around all cells visits them evenly, however early it ends.
  const std::int64_t cells = rows * columns;
  auto step = static_cast<std::int64_t>(0.6180339887 * static_cast<double>(cells));
  while (std::gcd(step, cells) != 1) ++step;
  const std::int64_t tries = std::min<std::int64_t>(cells, 6 * static_cast<std::int64_t>(most));
  std::array<int, kFacings> count_facing{};
  const int most_facing = std::max(1, most / 3);
  patches.reserve(static_cast<std::size_t>(most));
  for (std::int64_t i = 0, cell = 0; i < tries && static_cast<int>(patches.size()) < most; ++i) {
    cell += step;
    if (cell >= cells) cell -= cells;
    const int row = half_rows + static_cast<int>(cell / columns);
    const auto column = static_cast<int>(cell % columns);
    const int facing = facing_at_first_sight(sweep, row, column, half_rows);
    if (facing < 0 || count_facing[static_cast<std::size_t>(facing)] >= most_facing) continue;
    const auto patch = patch_around(sweep, row, column, half_rows);
    if (!patch) continue;
    ++count_facing[static_cast<std::size_t>(facing)];
    patches.push_back(*patch);
  }
  return patches;
}

}  // namespace pointreel
