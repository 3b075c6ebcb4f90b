// How far the returns of a reference are from the planes of moved patches, eight at once.

#if defined(POINTREEL_MOTION_PATCH_MEASURING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_MOTION_PATCH_MEASURING_INL_H_
#undef POINTREEL_MOTION_PATCH_MEASURING_INL_H_
#else
#define POINTREEL_MOTION_PATCH_MEASURING_INL_H_
#endif

#include "base/arc_tangent-inl.h"
#include "base/lanes-inl.h"
#include "motion/grid_matching.h"
#include "motion/patch_block.h"
#include "motion/range_grid.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// A member of the rows of a grid.
POINTREEL_INLINE Float8 of_rows(const GridRays::Row& first, float GridRays::Row::*member, const Int8& row) {
  static_assert(sizeof(GridRays::Row) == 8 * sizeof(float));
  return gather(&(first.*member), shifted_left<3>(row));
}
POINTREEL_INLINE Int8 turned_by(const GridRays::Row& first, const Int8& row) {
  return gather(&first.turned_by, shifted_left<3>(row));
}

// Of columns less than a turn outside.
POINTREEL_INLINE Int8 in_turn(const Int8& column, const Int8& columns) {
  const Int8 from_0 = column + where(all_ints<8>(0) > column, columns);
  return from_0 - where(from_0 > columns - all_ints<8>(1), columns);
}

// The rows that points lie nearest to in height; those beyond the outermost rows stop counting.
POINTREEL_INLINE Int8 rows_towards(const GridRays& grid, const Float8& z_m, const Float8& rho_m,
                                   Mask<8>& counts) {
  constexpr float kSlack = 4;  // bins beyond the outermost rows
  using Row = GridRays::Row;
  const auto& directions = grid.directions();
  const Row& first = grid.rows().front();
  const Float8 zero = all<8>(0), last_bin = all<8>(static_cast<float>(directions.row_of_bin.size() - 1));
  const Float8 slope = (z_m - all<8>(directions.mean_offset_m)) / select(counts, rho_m, all<8>(1));
  const Float8 bin = directions.bins_per_slope * (slope - all<8>(directions.lowest_slope));
  counts = counts & (all<8>(-kSlack) < bin) & (bin < last_bin + all<8>(kSlack));
  Int8 row =
      gather(directions.row_of_bin.data(), truncated(where(counts, smaller(larger(bin, zero), last_bin))));
  // Offsets differ between rows, which matters near the sensor.
  const auto height_above = [&](const Int8& of_row) HWY_ATTR {
    return z_m - of_rows(first, &Row::offset_m, of_row) - of_rows(first, &Row::slope, of_row) * rho_m;
  };
  Float8 here_m = height_above(row);
  const Int8 last_row = all_ints<8>(grid.row_count() - 1);
  const Int8 step = select(as_int_mask(zero < here_m), all_ints<8>(-1), all_ints<8>(1));
  for (;;) {
    const Int8 next = smaller(larger(row + step, all_ints<8>(0)), last_row);
    const Float8 next_m = height_above(next);
    const Mask<8> nearer = counts & (absolute(next_m) < absolute(here_m));
    if (!any(nearer)) return row;
    row = select(as_int_mask(nearer), next, row);
    here_m = select(nearer, next_m, here_m);
  }
}

// The columns of rows that look towards points.
POINTREEL_INLINE Int8 columns_towards(const GridRays& grid, const Int8& row, const Float8& x_m,
                                      const Float8& y_m, const Float8& rho_m, const Mask<8>& counts) {
  using Row = GridRays::Row;
  const auto& directions = grid.directions();
  const Row& first = grid.rows().front();
  const Float8 azimuth_rad = arc_tangent(y_m, x_m) - of_rows(first, &Row::azimuth_rad, row) -
                             of_rows(first, &Row::side_offset_m, row) / select(counts, rho_m, all<8>(1));
  // Two turns up, so that nothing is below 0.
  const auto bins = static_cast<std::int32_t>(directions.column_of_bin.size());
  const Float8 place = directions.bins_per_rad * azimuth_rad + all<8>(0.5F + static_cast<float>(2 * bins));
  return gather(directions.column_of_bin.data(), truncated(where(counts, place)) & all_ints<8>(bins - 1));
}

inline constexpr float kFarthestM = 1e6F;

// Where patches are: their points and normals.
struct PatchLanes {
  Float8 x_m, y_m, z_m, normal_x, normal_y, normal_z;

  PatchLanes(const PatchBlock& block, std::size_t first)
      : x_m(load<8>(&block.x_m[first])),
        y_m(load<8>(&block.y_m[first])),
        z_m(load<8>(&block.z_m[first])),
        normal_x(load<8>(&block.normal_x[first])),
        normal_y(load<8>(&block.normal_y[first])),
        normal_z(load<8>(&block.normal_z[first])) {}
};

// How far patches are from the returns of a row's cells, along their normals.
class RowDistances {
 public:
  POINTREEL_INLINE RowDistances(const GridRays& grid, const Int8& row, const PatchLanes& patch)
      : grid_(grid), row_begin_(row * all_ints<8>(grid.column_count())) {
    using Row = GridRays::Row;
    const Row& first = grid.rows().front();
    const Float8 cosine = of_rows(first, &Row::cos_azimuth, row),
                 sine = of_rows(first, &Row::sin_azimuth, row);
    // The normal in the row's turned axes.
    ahead_ = patch.normal_x * cosine + patch.normal_y * sine;
    beside_ = patch.normal_y * cosine - patch.normal_x * sine;
    up_ = patch.normal_z * of_rows(first, &Row::slope, row);
    side_offset_m_ = of_rows(first, &Row::side_offset_m, row);
    cos_elevation_ = of_rows(first, &Row::cos_elevation, row);
    plane_m_ = (patch.normal_x * patch.x_m + patch.normal_y * patch.y_m) +
               patch.normal_z * (patch.z_m - of_rows(first, &Row::offset_m, row));
  }

  // `found`: whether there are returns.
  POINTREEL_INLINE Float8 to_column(const Int8& column, Mask<8>& found) const {
    const Float8 cosine = gather(grid_.cos_azimuth().data(), column);
    const Float8 sine = gather(grid_.sin_azimuth().data(), column);
    const Float8 range_m = gather(grid_.ranges_m().data(), row_begin_ + column);
    found = (all<8>(0) < range_m) & (range_m < all<8>(kFarthestM));
    const Float8 along_ray = (ahead_ * cosine + beside_ * sine) + up_;
    const Float8 along_side = beside_ * cosine - ahead_ * sine;
    return plane_m_ - (range_m * cos_elevation_) * along_ray - side_offset_m_ * along_side;
  }

 private:
  const GridRays& grid_;
  Int8 row_begin_;
  Float8 ahead_, beside_, up_, side_offset_m_, cos_elevation_, plane_m_;
};

// Means of the distances to the returns around cells, those near the planes above all: what else is there,
// such as behind an edge, hardly counts. The return that is nearest, in place of a mean, would be the one
// whose noise makes it so, wherever the patch is: motions came out short of what had changed since the guess.
struct MeanDistances {
  static constexpr float kNearM = 0.3F;  // at this distance a quarter counts
  Float8 mean_m;
  Mask<8> any;  // there are returns

  POINTREEL_INLINE MeanDistances(const GridRays& grid, const Int8& middle, const Int8& middle_column,
                                 const PatchLanes& patch) {
    const GridRays::Row& first = grid.rows().front();
    const int rows_beside = half_patch_rows(grid) - 1;  // few rows are far apart
    const Int8 columns = all_ints<8>(grid.column_count()), last_row = all_ints<8>(grid.row_count() - 1);
    const Int8 turned = turned_by(first, middle);
    Float8 sum_m = all<8>(0), weights = all<8>(0);
    for (int down = -rows_beside; down <= rows_beside; ++down) {
      const Int8 row_there = middle + all_ints<8>(down);
      const Int8 row = smaller(larger(row_there, all_ints<8>(0)), last_row);
      const Float8 number = as_floats(row_there);
      const Mask<8> inside = (all<8>(0) <= number) & (number <= as_floats(last_row));
      const Int8 same = in_turn(middle_column + turned - turned_by(first, row), columns);
      const RowDistances distances(grid, row, patch);
      for (int beside = -kHalfPatchColumns; beside <= kHalfPatchColumns; ++beside) {
        Mask<8> found;
        const Float8 distance_m = distances.to_column(in_turn(same + all_ints<8>(beside), columns), found);
        const Float8 share = all<8>(kNearM * kNearM) / (all<8>(kNearM * kNearM) + distance_m * distance_m);
        const Float8 weight = where(found & inside, share * share);
        sum_m = sum_m + where(found, weight * distance_m);
        weights = weights + weight;
      }
    }
    any = all<8>(0) < weights;
    mean_m = sum_m / select(any, weights, all<8>(1));
  }
};

inline void measure(const GridRays& grid, PatchBlock& block) {
  constexpr float kNearestM = 0.1F;
  for (std::size_t i = 0; i < block.count; i += 8) {
    const PatchLanes patch(block, i);
    const Float8 rho_m = square_root(patch.x_m * patch.x_m + patch.y_m * patch.y_m);
    Mask<8> counts = (all<8>(kNearestM) < rho_m) & (rho_m < all<8>(kFarthestM)) &
                     (absolute(patch.z_m) < all<8>(kFarthestM));
    const Int8 row = rows_towards(grid, patch.z_m, rho_m, counts);
    const Int8 column = columns_towards(grid, row, patch.x_m, patch.y_m, rho_m, counts);
    const MeanDistances distances(grid, row, column, patch);
    store(select(counts & distances.any, distances.mean_m, all<8>(PatchBlock::kNoPartner)),
          &block.distance_m[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
