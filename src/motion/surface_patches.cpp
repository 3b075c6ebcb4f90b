#include "motion/surface_patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "motion/grid_matching.h"

namespace pointreel {
namespace {

constexpr float kNearestM = 1;  // nearer is the vehicle itself
constexpr float kFarthestM = 80;

// A look at a cell's four far neighbours alone, which settles most cases: the direction that a plane through
// them would face; negative: there is none.
int facing_at_first_sight(const GridRays& sweep, int row, int column, int half_rows) {
  constexpr float kBentM = 0.3F;
  const float center_m = sweep.range_m(row, column);
  if (!(center_m > kNearestM && center_m < kFarthestM)) return -1;
  const int left = sweep.wrapped(column - kHalfPatchColumns),
            right = sweep.wrapped(column + kHalfPatchColumns);
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

}  // namespace

std::vector<SurfacePatch> find_surface_patches(const GridRays& sweep, int most) {
  const int half_rows = half_patch_rows(sweep);
  const std::int64_t rows = sweep.row_count() - std::int64_t{2} * half_rows, columns = sweep.column_count();
  std::vector<SurfacePatch> patches;
  if (rows < 1 || columns < std::int64_t{4} * kHalfPatchColumns || most < 1) return patches;
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
