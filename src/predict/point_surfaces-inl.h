// How the surfaces of moved points lean, and what that says about the cells nearest to them, eight at once.

#if defined(POINTREEL_PREDICT_POINT_SURFACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_POINT_SURFACES_INL_H_
#undef POINTREEL_PREDICT_POINT_SURFACES_INL_H_
#else
#define POINTREEL_PREDICT_POINT_SURFACES_INL_H_
#endif

#include "base/lanes-inl.h"
#include "predict/point_moving.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// From points to neighbours on their surface; 0 where there is none.
struct SurfaceStep {
  Mask<8> same;
  Float8 rows, columns, u;  // u: inverse_rho

  // `apart`: of the two in the arrays.
  POINTREEL_INLINE SurfaceStep(const WarpedPoints& points, std::size_t at, std::ptrdiff_t apart,
                               float width) {
    const auto to = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + apart);
    const auto between = [&](const std::vector<float>& values)
                             HWY_ATTR { return load<8>(&values[to]) - load<8>(&values[at]); };
    const Float8 range_m = load<8>(&points.range_m[at]), other_m = load<8>(&points.range_m[to]);
    same = (absolute(other_m - range_m) <= 0.03F * range_m + all<8>(0.3F)) & (all<8>(0) < other_m);
    // Across the seam of the image, if that is shorter.
    Float8 across = between(points.column);
    across = across - where(all<8>(0.5F * width) < across, all<8>(width));
    across = across + where(across < all<8>(-0.5F * width), all<8>(width));
    rows = where(same, between(points.row));
    columns = where(same, across);
    u = where(same, between(points.inverse_rho));
  }
};

struct SurfaceSlopes {
  Float8 per_column, per_row;

  // From the steps to the right less those to the left, and down less up.
  POINTREEL_INLINE SurfaceSlopes(const SurfaceStep& right, const SurfaceStep& left, const SurfaceStep& down,
                                 const SurfaceStep& up) {
    const Float8 row_rows = right.rows - left.rows, row_columns = right.columns - left.columns,
                 row_u = right.u - left.u;
    const Float8 column_rows = down.rows - up.rows, column_columns = down.columns - up.columns,
                 column_u = down.u - up.u;
    constexpr float kLeastDeterminant2 = 0.01F, kLeastStep2 = 0.04F;
    const Float8 one = all<8>(1);
    const Float8 determinant = row_columns * column_rows - row_rows * column_columns;
    const Mask<8> plane = all<8>(kLeastDeterminant2) < determinant * determinant;
    const Mask<8> has_row = all<8>(kLeastStep2) < row_columns * row_columns;
    const Mask<8> has_column = all<8>(kLeastStep2) < column_rows * column_rows;
    const Float8 per_determinant = one / select(plane, determinant, one);
    const Float8 only_row = where(has_row, row_u / select(has_row, row_columns, one));
    const Float8 along_column = where(has_column, column_u / select(has_column, column_rows, one));
    const Float8 only_column = select(has_row, all<8>(0), along_column);
    per_column = select(plane, (row_u * column_rows - row_rows * column_u) * per_determinant, only_row);
    per_row = select(plane, (row_columns * column_u - row_u * column_columns) * per_determinant, only_column);
  }
};

// Column indices less than two widths too far: a turned row, and a last column of its own.
POINTREEL_INLINE Int8 wrapped(const Int8& column, int columns) {
  const Int8 width = all_ints<8>(columns), last = all_ints<8>(columns - 1);
  const Int8 once = column - where(column > last, width);
  return once - where(once > last, width);
}

inline void find_surfaces_of_row(int row, int columns, const WarpTarget& target, const WarpCanvas& canvas,
                                 WarpedPoints& points) {
  const auto stride = static_cast<std::ptrdiff_t>(points.stride());
  const auto width = static_cast<float>(target.columns);
  const Int8 none = all_ints<8>(WarpedPoints::kNone), first_cell = all_ints<8>(canvas.first_of_row(0));
  const Float8 one = all<8>(1), half = all<8>(0.5F);
  for (std::size_t at = points.index(row, 0); at < points.index(row, columns); at += 8) {
    const SurfaceStep right(points, at, 1, width), left(points, at, -1, width);
    const SurfaceStep below(points, at, stride, width), above(points, at, -stride, width);
    const SurfaceSlopes slopes(right, left, below, above);
    const auto side = [](const SurfaceStep& step, SurfaceSide bit)
                          HWY_ATTR { return where(as_int_mask(step.same), all_ints<8>(bit)); };
    store((side(right, kRight) | side(left, kLeft)) | (side(below, kBelow) | side(above, kAbove)),
          &points.sides[at]);

    // Those that are no points are anywhere. Rows from -1 on, rounded.
    const Mask<8> is_point = all<8>(0) < load<8>(&points.range_m[at]);
    const Float8 at_row = where(is_point, load<8>(&points.row[at]));
    const Float8 at_column = where(is_point, load<8>(&points.column[at]));
    const Int8 near_row = truncated(at_row + (one + half)) - all_ints<8>(1);
    const Int8 near_column = truncated(at_column + half);
    const IntMask<8> outside = (all_ints<8>(0) > near_row) | (near_row > all_ints<8>(target.rows - 1));
    const Float8 rows_off = as_floats(near_row) - at_row, columns_off = as_floats(near_column) - at_column;
    const Float8 u = select(is_point, load<8>(&points.inverse_rho[at]), one);
    const Float8 moved = u + (slopes.per_row * rows_off + slopes.per_column * columns_off);
    const Float8 limited = smaller(larger(moved, 0.8F * u), 1.25F * u);
    const Int8 valid_row = select(outside, all_ints<8>(0), near_row);
    store(gather(target.range_per_rho.data(), valid_row) / limited, &points.nearest_range_m[at]);
    store((all<8>(1.02F) - absolute(rows_off)) * (all<8>(1.02F) - absolute(columns_off)),
          &points.nearest_weight[at]);
    const Int8 cell =
        first_cell + near_row * all_ints<8>(canvas.stride) + wrapped(near_column, target.columns);
    store(select(as_int_mask(is_point), select(outside, none, cell), none), &points.nearest_cell[at]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
