// Eight columns of a tile at once: does a plane hold them, and can any?

#if defined(POINTREEL_PLANES_TILE_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PLANES_TILE_TESTS_INL_H_
#undef POINTREEL_PLANES_TILE_TESTS_INL_H_
#else
#define POINTREEL_PLANES_TILE_TESTS_INL_H_
#endif

#include "base/lanes-inl.h"
#include "planes/tile_tests.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

static_assert(kTileColumns == 8);

inline bool tile_holds(std::span<const PlaneInRow> rows, std::size_t column) {
  Float8 outside = all<8>(0);  // 1 where any is; also of planes that are none
  for (const PlaneInRow& row : rows) {
    const SensorRays::RowPlane& plane = row.plane;
    const Float8 cosine = load<8>(row.cells.cosine + column), sine = load<8>(row.cells.sine + column);
    const Float8 denominator = (plane.along * cosine + plane.across * sine) + all<8>(plane.up);
    const Float8 numerator =
        all<8>(plane.at_zero) + plane.side_offset_m * (plane.along * sine - plane.across * cosine);
    const Float8 off = absolute(numerator - load<8>(row.cells.rho_m + column) * denominator);
    const Mask<8> within = off <= load<8>(row.cells.tolerance_m + column) * denominator;
    outside = select(within, outside, all<8>(1));
  }
  return !any(all<8>(0) < outside);
}

// Eight cells of a row, from a column on.
struct RowPart {
  Float8 cosine, sine;
  Float8 per_rho_m, tolerance;  // of 1 / rho, 1/m

  POINTREEL_INLINE RowPart(const RowCells& row, std::size_t column)
      : cosine(load<8>(row.cosine + column)),
        sine(load<8>(row.sine + column)),
        per_rho_m(load<8>(row.per_rho_m + column)) {
    const Float8 share = load<8>(row.tolerance_m + column) * per_rho_m;
    tolerance = (share * per_rho_m) * (all<8>(1) + 2 * share);  // 1 / (rho - tolerance) - 1 / rho
  }
};
POINTREEL_INLINE Float8 sine_between(const RowPart& from, const RowPart& to) {
  return to.sine * from.cosine - to.cosine * from.sine;
}

// Along a row, 1 / rho of a plane is a sine of the azimuth, of which three cells tell
//   sin(a2 - a0) u1 = sin(a2 - a1) u0 + sin(a1 - a0) u2
// but for the constant n_z slope (here for slopes of up to 0.5), for side offsets, and for roundings of the
// sines. (Every other cell tells: those side by side, or three apart, find hardly a tile more.)
inline bool tile_bends(std::span<const RowCells> rows, std::size_t column) {
  constexpr std::size_t kApart = 2;
  constexpr float kMostConstant = 0.5F, kMostSideOffset = 0.05F;  // times 1 / m: of planes from 1 m on
  constexpr float kRounding = 4e-7F;
  static_assert(2 * kApart <= kCellsBeyond && kTileColumns + 2 * kApart <= SensorRays::kColumnsMore);
  static constexpr float kThreeInTile[kTileColumns] = {1, 1, 1, 1};
  for (const RowCells& row : rows) {
    const RowPart first(row, column), middle(row, column + kApart), last(row, column + 2 * kApart);
    const Float8 of_first = sine_between(middle, last), of_last = sine_between(first, middle),
                 of_middle = sine_between(first, last);
    const Float8 bend =
        absolute((first.per_rho_m * of_first + last.per_rho_m * of_last) - middle.per_rho_m * of_middle);
    const Float8 of_constant = kMostConstant * absolute((of_first + of_last) - of_middle);
    const Float8 of_side =
        (kMostSideOffset * absolute(of_middle)) *
        (absolute(last.per_rho_m - first.per_rho_m) + absolute(of_middle) * middle.per_rho_m);
    const Float8 most = (first.tolerance * absolute(of_first) + last.tolerance * absolute(of_last)) +
                        (middle.tolerance + of_side) * absolute(of_middle) + of_constant +
                        kRounding * middle.per_rho_m;
    if (any(all<8>(0) < (bend - most) * load<8>(kThreeInTile))) return true;
  }
  return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
