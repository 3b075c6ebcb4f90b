// How far the returns of a reference are from the planes of moved patches, eight at once.

#if defined(POINTREEL_MOTION_PATCH_MEASURING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_MOTION_PATCH_MEASURING_INL_H_
#undef POINTREEL_MOTION_PATCH_MEASURING_INL_H_
#else
#define POINTREEL_MOTION_PATCH_MEASURING_INL_H_
#endif

#include "base/arc_tangent-inl.h"
#include "base/lanes-inl.h"
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

// Of the cells that look towards points or just beside them, those whose returns are most nearly as far away.
struct NearReturns {
  Int8 row, column;
  Float8 rho_m, away_m;  // away_m infinite: none has a return

  POINTREEL_INLINE NearReturns(const GridRays& grid, const Int8& middle, const Int8& middle_column,
                               const Float8& at_rho_m)
      : row(middle), column(middle_column), rho_m(all<8>(0)), away_m(all<8>(PatchBlock::kNoPartner)) {
    using Row = GridRays::Row;
    const Row& first = grid.rows().front();
    const Int8 columns = all_ints<8>(grid.column_count());
    const Int8 turned = turned_by(first, middle);
    for (int down = -1; down <= 1; ++down) {
      const Int8 here =
          smaller(larger(middle + all_ints<8>(down), all_ints<8>(0)), all_ints<8>(grid.row_count() - 1));
      const Float8 cos_elevation = of_rows(first, &Row::cos_elevation, here);
      const Int8 same = in_turn(middle_column + turned - turned_by(first, here), columns);
      const Int8 row_begin = here * columns;
      for (int beside = -1; beside <= 1; ++beside) {
        const Int8 there = in_turn(same + all_ints<8>(beside), columns);
        const Float8 range_m = gather(grid.ranges_m().data(), row_begin + there);
        const Float8 there_rho_m = range_m * cos_elevation;
        const Float8 there_away_m = absolute(there_rho_m - at_rho_m);
        const Mask<8> better = (all<8>(0) < range_m) & (there_away_m < away_m);
        row = select(as_int_mask(better), here, row);
        column = select(as_int_mask(better), there, column);
        rho_m = select(better, there_rho_m, rho_m);
        away_m = select(better, there_away_m, away_m);
      }
    }
  }
};

inline void measure(const GridRays& grid, PatchBlock& block) {
  constexpr float kNearestM = 0.1F, kFarthestM = 1e6F;
  using Row = GridRays::Row;
  for (std::size_t i = 0; i < block.count; i += 8) {
    const Float8 x_m = load<8>(&block.x_m[i]), y_m = load<8>(&block.y_m[i]), z_m = load<8>(&block.z_m[i]);
    const Float8 rho_m = square_root(x_m * x_m + y_m * y_m);
    Mask<8> counts =
        (all<8>(kNearestM) < rho_m) & (rho_m < all<8>(kFarthestM)) & (absolute(z_m) < all<8>(kFarthestM));
    const Int8 row = rows_towards(grid, z_m, rho_m, counts);
    const NearReturns near(grid, row, columns_towards(grid, row, x_m, y_m, rho_m, counts), rho_m);
    const Row& first = grid.rows().front();
    const Float8 cos_column = gather(grid.cos_azimuth().data(), near.column);
    const Float8 sin_column = gather(grid.sin_azimuth().data(), near.column);
    const Float8 cos_row = of_rows(first, &Row::cos_azimuth, near.row);
    const Float8 sin_row = of_rows(first, &Row::sin_azimuth, near.row);
    const Float8 cosine = cos_column * cos_row - sin_column * sin_row;
    const Float8 sine = sin_column * cos_row + cos_column * sin_row;
    const Float8 side_m = of_rows(first, &Row::side_offset_m, near.row);
    const Float8 away_x = x_m - (near.rho_m * cosine - side_m * sine);
    const Float8 away_y = y_m - (near.rho_m * sine + side_m * cosine);
    const Float8 away_z =
        z_m - (of_rows(first, &Row::slope, near.row) * near.rho_m + of_rows(first, &Row::offset_m, near.row));
    const Float8 distance_m = (load<8>(&block.normal_x[i]) * away_x + load<8>(&block.normal_y[i]) * away_y) +
                              load<8>(&block.normal_z[i]) * away_z;
    const Float8 none = all<8>(PatchBlock::kNoPartner);
    store(select(counts & (near.away_m < none), distance_m, none), &block.distance_m[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
