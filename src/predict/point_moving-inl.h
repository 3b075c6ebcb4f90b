// Where the points of a row of the reference fall in this sweep's image, eight at once.

#if defined(POINTREEL_PREDICT_POINT_MOVING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_POINT_MOVING_INL_H_
#undef POINTREEL_PREDICT_POINT_MOVING_INL_H_
#else
#define POINTREEL_PREDICT_POINT_MOVING_INL_H_
#endif

#include "base/arc_tangent-inl.h"
#include "base/lanes-inl.h"
#include "predict/point_moving.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr float kNearestM = 0.05F;  // from the axis: nearer points have no direction
inline constexpr float kFarthestM = 1e5F;  // whatever a damaged pose says, numbers stay finite

struct Positions {
  Float8 x_m, y_m, z_m;
};

// Where rays of a row end, as RayTable has it.
POINTREEL_INLINE Positions positions_on_rays(const WarpSource::Row& row, const Float8& sin_column,
                                             const Float8& cos_column, const Float8& range_m) {
  const Float8 rho_m = row.cos_elevation * range_m;
  const Float8 sine = row.cos_azimuth * sin_column + row.sin_azimuth * cos_column;
  const Float8 cosine = row.cos_azimuth * cos_column - row.sin_azimuth * sin_column;
  const Float8 side_m = all<8>(row.side_offset_m);
  const Float8 scale = rho_m / larger(square_root(rho_m * rho_m + side_m * side_m), all<8>(1e-30F));
  return {scale * (rho_m * cosine - side_m * sine), scale * (rho_m * sine + side_m * cosine),
          row.slope * rho_m + all<8>(row.offset_m)};
}

POINTREEL_INLINE Positions moved(const Positions& p, const PointMotion& motion) {
  const auto& r = motion.rotation;
  const auto& t = motion.translation_m;
  return {(r[0] * p.x_m + r[1] * p.y_m) + (r[2] * p.z_m + all<8>(t[0])),
          (r[3] * p.x_m + r[4] * p.y_m) + (r[5] * p.z_m + all<8>(t[1])),
          (r[6] * p.x_m + r[7] * p.y_m) + (r[8] * p.z_m + all<8>(t[2]))};
}

// Of points `at` which a motion moves those of the reference: where they are at the time when the sensor
// looks there now.
POINTREEL_INLINE Positions later(const Positions& at, const Positions& before, const Float8& rho_before_m,
                                 const PointMotion& motion) {
  const Float8 rho_m = square_root(at.x_m * at.x_m + at.y_m * at.y_m);
  const Float8 sine =
      (before.x_m * at.y_m - before.y_m * at.x_m) / larger(rho_before_m * rho_m, all<8>(1e-30F));
  const Float8 more = motion.per_sine * sine;
  const auto& t = motion.translation_m;
  return {at.x_m + more * all<8>(t[0]), at.y_m + more * all<8>(t[1]), at.z_m + more * all<8>(t[2])};
}

// The rows of points as numbers between those of the cones that they lie between. All lanes look at one cone
// after the other, up and down from that of `start`: points of one row stay near each other. Lanes that do
// not count are anywhere.
POINTREEL_INLINE Float8 between_rows(const WarpTarget& target, int start, const Float8& z_m,
                                     const Float8& rho_m, const Mask<8>& counts) {
  const auto height_above = [&](int row) HWY_ATTR {
    const auto cone = static_cast<std::size_t>(row + WarpTarget::kRowsAround);
    return z_m - (target.slope[cone] * rho_m + all<8>(target.offset_m[cone]));
  };
  const Float8 zero = all<8>(0), start_m = height_above(start);
  Float8 upper = all<8>(static_cast<float>(start)), upper_m = start_m, lower_m = start_m;
  Float8 last_m = start_m;
  Mask<8> walking = counts & (zero <= start_m);
  for (int row = start - 1; any(walking); --row) {
    const Float8 here_m = height_above(row);
    upper = select(walking, all<8>(static_cast<float>(row)), upper);
    upper_m = select(walking, here_m, upper_m);
    lower_m = select(walking, last_m, lower_m);
    walking = walking & (zero <= here_m);
    last_m = here_m;
  }
  last_m = start_m;
  walking = counts & (start_m < zero);
  for (int row = start + 1; any(walking); ++row) {
    const Float8 here_m = height_above(row);
    upper = select(walking, all<8>(static_cast<float>(row - 1)), upper);
    upper_m = select(walking, last_m, upper_m);
    lower_m = select(walking, here_m, lower_m);
    walking = walking & (here_m < zero);
    last_m = here_m;
  }
  return upper - upper_m / larger(lower_m - upper_m, all<8>(1e-4F));
}

POINTREEL_INLINE Float8 in_one_turn(const Float8& turns) {
  const Float8 part = turns - as_floats(truncated(turns));
  return part + where(part < all<8>(0), all<8>(1));
}

// The columns at azimuths in turns, as ColumnFinder has them; lanes that are near none stop counting.
POINTREEL_INLINE Float8 between_columns(const ColumnFinder& finder, const Float8& turns, Mask<8>& counts) {
  const Float8 place = static_cast<float>(finder.bins()) * turns;
  const Int8 bin = truncated(place);
  const Float8 column =
      gather(finder.at_start(), bin) + (place - as_floats(bin)) * gather(finder.per_bin(), bin);
  counts = counts & (all<8>(ColumnFinder::kNowhere) < column);
  return larger(column, all<8>(0));
}

inline void move_points_of_row(const GridImage& reference, int row, const WarpSource& source,
                               const PointMotion& motion, const WarpTarget& target, WarpedPoints& points) {
  constexpr float kMostBeyond = 0.6F;  // of a row, the first and the last
  const auto columns = static_cast<std::size_t>(reference.columns);
  const std::size_t first_point = points.index(row, 0);
  const float* ranges_m = &reference.range_m[reference.index(row, 0)];
  const WarpSource::Row& ray = source.rows[static_cast<std::size_t>(row)];
  const float* sin_column = &source.sin_azimuth[ray.first_column];
  const float* cos_column = &source.cos_azimuth[ray.first_column];
  const Float8 last_row = all<8>(static_cast<float>(target.rows - 1));
  for (std::size_t c = 0; c < columns; c += 8) {
    const Float8 found_m = load_first<8>(ranges_m + c, columns - c);
    const Float8 range_m = where(found_m < all<8>(kFarthestM), found_m);
    const Positions before =
        positions_on_rays(ray, load<8>(sin_column + c), load<8>(cos_column + c), range_m);
    const Positions p = later(moved(before, motion), before, ray.cos_elevation * range_m, motion);
    const Float8 rho_m = square_root(p.x_m * p.x_m + p.y_m * p.y_m);
    Mask<8> counts = (all<8>(0) < range_m) & (all<8>(kNearestM) < rho_m) & (rho_m < all<8>(kFarthestM)) &
                     (absolute(p.z_m) < all<8>(kFarthestM));
    const Float8 between = where(counts, between_rows(target, row, p.z_m, rho_m, counts));
    counts = counts & (all<8>(-kMostBeyond) <= between) & (between <= last_row + all<8>(kMostBeyond));
    const Int8 nearest_row = truncated(smaller(larger(between, all<8>(0)), last_row) + all<8>(0.5F));
    const Float8 turns =
        in_one_turn(where(counts, arc_tangent(p.y_m, p.x_m) * all<8>(static_cast<float>(1 / kTurn)) -
                                      gather(target.azimuth_turns.data(), nearest_row) -
                                      gather(target.side_turns_m.data(), nearest_row) / rho_m));
    const Float8 column = between_columns(target.finder, turns, counts);
    const std::size_t at = first_point + c;
    store(between, &points.row[at]);
    store(column + gather(target.shift.data(), nearest_row), &points.column[at]);
    store(where(counts, all<8>(1) / rho_m), &points.inverse_rho[at]);
    store(where(counts, range_m), &points.range_m[at]);
  }
  // The reference goes around.
  for (auto* values : {&points.row, &points.column, &points.inverse_rho, &points.range_m}) {
    (*values)[first_point - 1] = (*values)[first_point + columns - 1];
    (*values)[first_point + columns] = (*values)[first_point];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
