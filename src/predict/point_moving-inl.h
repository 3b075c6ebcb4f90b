// Where the points of a row of the reference fall in this sweep's image, eight at once.

#if defined(POINTREEL_PREDICT_POINT_MOVING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_POINT_MOVING_INL_H_
#undef POINTREEL_PREDICT_POINT_MOVING_INL_H_
#else
#define POINTREEL_PREDICT_POINT_MOVING_INL_H_
#endif

#include <algorithm>

#include "base/trigonometry.h"
#include "predict/lanes-inl.h"
#include "predict/point_moving.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr float kNearestM = 0.05F;  // from the axis: nearer points have no direction
inline constexpr float kFarthestM = 1e5F;  // whatever a damaged pose says, numbers stay finite

// fast_atan2 of base/trigonometry.h.
POINTREEL_INLINE Float8 arc_tangent(const Float8& y, const Float8& x) {
  const Float8 ax = absolute(x), ay = absolute(y);
  const Mask<8> steep = ax < ay;
  const Float8 t = select(steep, ax, ay) / larger(select(steep, ay, ax), all<8>(1e-37F));
  const Float8 t2 = t * t;
  Float8 ratio = all<8>(kArcTangentCoefficients[9]);
  for (int i = 8; i >= 0; --i) ratio = ratio * t2 + all<8>(kArcTangentCoefficients[i]);
  constexpr auto kHalfTurn = static_cast<float>(kPi);
  Float8 angle = ratio * t;
  angle = select(steep, all<8>(kHalfTurn / 2) - angle, angle);
  angle = select(x < all<8>(0), all<8>(kHalfTurn) - angle, angle);
  return select(y < all<8>(0), all<8>(0) - angle, angle);
}

// The rows that lie nearest to eight points in height.
struct NearestRows {
  Int8 row;
  Float8 above_m;  // height of the point over the row's cone
};
class RowSearch {
 public:
  POINTREEL_INLINE RowSearch(const WarpTarget& target, const Float8& z_m, const Float8& rho_m)
      : target_(target), z_m_(z_m), rho_m_(rho_m) {}

  // Height above the cone of a row, from -1 to the number of rows.
  POINTREEL_INLINE Float8 height_above(const Int8& row) const {
    const Int8 at = row + all_ints<8>(1);
    return z_m_ - (gather(target_.slope.data(), at) * rho_m_ + gather(target_.offset_m.data(), at));
  }

  // Walks up, then down from `start`, as long as it gets nearer; lanes that do not count stay.
  POINTREEL_INLINE NearestRows from(std::int32_t start, const Mask<8>& counts) const {
    NearestRows nearest{all_ints<8>(start), height_above(all_ints<8>(start))};
    for (const std::int32_t step : {-1, 1}) {
      Mask<8> walking = counts;
      for (;;) {
        const Int8 next = nearest.row + all_ints<8>(step);
        const Float8 there_m = height_above(next);
        walking = walking & (absolute(there_m) < absolute(nearest.above_m));
        if (!any(walking)) break;
        nearest.row = select(as_int_mask(walking), next, nearest.row);
        nearest.above_m = select(walking, there_m, nearest.above_m);
      }
    }
    return nearest;
  }

 private:
  const WarpTarget& target_;
  Float8 z_m_, rho_m_;
};

// The row of each point as a number between rows; points farther beyond the first or the last than this lose
// their lane of `counts`.
POINTREEL_INLINE Float8 between_rows(const RowSearch& search, const NearestRows& nearest, int rows,
                                     Mask<8>& counts) {
  constexpr float kMostBeyond = 0.6F;
  const Int8 one = all_ints<8>(1);
  const Int8 step = select(as_int_mask(all<8>(0) < nearest.above_m), all_ints<8>(-1), one);
  const Int8 other = nearest.row + step;
  const IntMask<8> beyond_first = all_ints<8>(0) > other;
  const IntMask<8> beyond_last = other > all_ints<8>(rows - 1);
  const Mask<8> outside = as_float_mask(beyond_first | beyond_last);
  // Two rows tell the spacing: one beyond the image is out of reach, its inner neighbour is not.
  const Float8 other_m = select(outside, search.height_above(nearest.row - step), search.height_above(other));
  const Float8 spacing_m = absolute(other_m - nearest.above_m);
  const Mask<8> apart = all<8>(1e-4F) < spacing_m;
  const Float8 beside = where(apart, absolute(nearest.above_m) / select(apart, spacing_m, all<8>(1)));
  counts = counts & (select(outside, beside, all<8>(0)) <= all<8>(kMostBeyond));
  return as_floats(nearest.row) + as_floats(step) * smaller(beside, all<8>(1));
}

POINTREEL_INLINE Float8 in_one_turn(const Float8& turns) {
  const Float8 part = turns - as_floats(truncated(turns));
  return part + where(part < all<8>(0), all<8>(1));
}

inline void move_points_of_row(const ReferenceSweep& reference, int row, const PointMotion& motion,
                               const WarpTarget& target, WarpedPoints& points) {
  const auto columns = static_cast<std::size_t>(reference.columns);
  const std::size_t first = static_cast<std::size_t>(row) * columns, first_point = points.index(row, 0);
  const auto& r = motion.rotation;
  const auto& t = motion.translation_m;
  for (std::size_t c = 0; c < columns; c += 8) {
    const std::size_t here = std::min<std::size_t>(columns - c, 8);
    const auto load_here = [&](const std::vector<float>& values)
                               HWY_ATTR { return load_first<8>(&values[first + c], here); };
    const Float8 x = load_here(reference.x_m), y = load_here(reference.y_m), z = load_here(reference.z_m);
    const Float8 range_m = load_here(reference.range_m);
    const Float8 x_m = (r[0] * x + r[1] * y) + (r[2] * z + all<8>(t[0]));
    const Float8 y_m = (r[3] * x + r[4] * y) + (r[5] * z + all<8>(t[1]));
    const Float8 z_m = (r[6] * x + r[7] * y) + (r[8] * z + all<8>(t[2]));
    const Float8 rho_m = square_root(x_m * x_m + y_m * y_m);
    Mask<8> counts = (all<8>(0) < range_m) & (all<8>(kNearestM) < rho_m) & (rho_m < all<8>(kFarthestM)) &
                     (absolute(z_m) < all<8>(kFarthestM));
    const RowSearch search(target, z_m, rho_m);
    const NearestRows nearest = search.from(row, counts);
    const Float8 between = between_rows(search, nearest, target.rows, counts);
    const Float8 turns =
        in_one_turn(where(counts, arc_tangent(y_m, x_m) * all<8>(static_cast<float>(1 / (2 * kPi))) -
                                      gather(target.azimuth_turns.data(), nearest.row) -
                                      gather(target.side_turns_m.data(), nearest.row) / rho_m));
    alignas(32) float turn[8], column[8], shift[8];
    store(turns, turn);
    store(gather(target.shift.data(), nearest.row), shift);
    for (std::size_t i = 0; i < 8; ++i) {
      const float found = target.finder.position(turn[i]);
      column[i] = found < 0 ? found : found + shift[i];
    }
    counts = counts & (all<8>(0) <= load<8>(column));
    const std::size_t at = first_point + c;
    store(between, &points.row[at]);
    store(load<8>(column), &points.column[at]);
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
