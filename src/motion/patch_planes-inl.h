// The plane through the returns around a cell, a row of them at once.

#if defined(POINTREEL_MOTION_PATCH_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_MOTION_PATCH_PLANES_INL_H_
#undef POINTREEL_MOTION_PATCH_PLANES_INL_H_
#else
#define POINTREEL_MOTION_PATCH_PLANES_INL_H_
#endif

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "base/lanes-inl.h"
#include "motion/grid_matching.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Some of a row's returns; 0 in the lanes of those that do not count.
struct RowPoints {
  Float8 x_m, y_m, z_m, count;

  POINTREEL_INLINE RowPoints() : RowPoints(all<8>(0), all<8>(0), all<8>(0), all<8>(0)) {}
  POINTREEL_INLINE RowPoints(const Float8& x, const Float8& y, const Float8& z, const Float8& counts)
      : x_m(x), y_m(y), z_m(z), count(counts) {}

  POINTREEL_INLINE void add(const RowPoints& other) {
    x_m = x_m + other.x_m;
    y_m = y_m + other.y_m;
    z_m = z_m + other.z_m;
    count = count + other.count;
  }
};

// Of the lanes with weight 1.
struct MeanPoint {
  Eigen::Vector3f point_m;
  float count;

  POINTREEL_INLINE MeanPoint(const RowPoints& points, const Float8& weights)
      : point_m(sum(points.x_m * weights), sum(points.y_m * weights), sum(points.z_m * weights)),
        count(sum(points.count * weights)) {
    point_m *= 1 / std::max(count, 1.0F);
  }
};

// Of a patch's columns, from its first: all of them, those left and those right of the middle one.
static_assert(kHalfPatchColumns == 2);
alignas(32) inline constexpr float kAllColumns[8] = {1, 1, 1, 1, 1, 0, 0, 0};
alignas(32) inline constexpr float kLeftColumns[8] = {1, 1, 0, 0, 0, 0, 0, 0};
alignas(32) inline constexpr float kRightColumns[8] = {0, 0, 0, 1, 1, 0, 0, 0};

// The returns of eight columns, of which the first few count where their range is near that of the center.
POINTREEL_INLINE RowPoints points_near(const GridRays& sweep, int row, std::size_t first, float center_m) {
  constexpr float kRangeSpread = 0.3F;  // others are other things
  const GridRays::Row& r = sweep.rows()[static_cast<std::size_t>(row)];
  const std::size_t columns = sweep.cos_azimuth().size();
  const Float8 range_m = load<8>(&sweep.ranges_m()[static_cast<std::size_t>(row) * columns + first]);
  const Float8 cos_column = load<8>(&sweep.cos_azimuth()[first]);
  const Float8 sin_column = load<8>(&sweep.sin_azimuth()[first]);
  const Float8 cosine = r.cos_azimuth * cos_column - r.sin_azimuth * sin_column;
  const Float8 sine = r.cos_azimuth * sin_column + r.sin_azimuth * cos_column;
  const Float8 rho_m = r.cos_elevation * range_m;
  const Mask<8> counts = (absolute(range_m - all<8>(center_m)) < all<8>(kRangeSpread * center_m)) &
                         (all<8>(0) < load<8>(kAllColumns));
  return {where(counts, rho_m * cosine - r.side_offset_m * sine),
          where(counts, rho_m * sine + r.side_offset_m * cosine),
          where(counts, r.slope * rho_m + all<8>(r.offset_m)), where(counts, all<8>(1))};
}

// Its normal is across the two lines from the left to the right half's mean, and from the upper to the lower
// one's, which points missing here and there do not turn. Its center is the mean of the middle row, as wide
// as what it is compared with (patch_measuring-inl.h): both lie as far behind a convex surface. False: there
// is none.
inline bool plane_around(const GridRays& sweep, int row, int column, int half_rows, SurfacePatch& patch) {
  constexpr float kFlatWithinM = 0.04F;  // root mean square: noise, and rows that are not quite calibrated
  constexpr float kLeastReturns = 0.7F;  // share of the patch's cells
  const float center_m = sweep.range_m(row, column);
  RowPoints rows[2 * kMostHalfPatchRows + 1];
  RowPoints upper, lower;
  for (int dr = -half_rows; dr <= half_rows; ++dr) {
    const int first = sweep.same_direction(column, row, row + dr) - kHalfPatchColumns;
    if (first < 0 || first + 8 > sweep.column_count()) return false;  // at the seam
    RowPoints& here = rows[dr + half_rows];
    here = points_near(sweep, row + dr, static_cast<std::size_t>(first), center_m);
    if (dr != 0) (dr < 0 ? upper : lower).add(here);
  }
  RowPoints every = rows[half_rows];
  every.add(upper);
  every.add(lower);
  const Float8 one = all<8>(1);
  const MeanPoint all_m(every, one);
  const int cells = (2 * half_rows + 1) * (2 * kHalfPatchColumns + 1);
  if (all_m.count < kLeastReturns * static_cast<float>(cells)) return false;
  const MeanPoint left(every, load<8>(kLeftColumns)), right(every, load<8>(kRightColumns));
  const MeanPoint above(upper, one), below(lower, one);
  if (left.count == 0 || right.count == 0 || above.count == 0 || below.count == 0) return false;
  const Eigen::Vector3f across = (right.point_m - left.point_m).cross(below.point_m - above.point_m);
  const float length = across.norm();
  if (!(length > 1e-9F)) return false;
  patch = {MeanPoint(rows[half_rows], one).point_m, across / length};

  const float middle_m = patch.normal.dot(all_m.point_m);
  Float8 squares_m2 = all<8>(0);
  for (int i = 0; i <= 2 * half_rows; ++i) {
    const Float8 away_m = (patch.normal.x() * rows[i].x_m + patch.normal.y() * rows[i].y_m) +
                          (patch.normal.z() * rows[i].z_m - middle_m * rows[i].count);
    squares_m2 = squares_m2 + away_m * away_m;
  }
  return sum(squares_m2) < kFlatWithinM * kFlatWithinM * all_m.count;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
