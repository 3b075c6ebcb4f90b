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
  Float8 farthest = all<8>(0);  // beyond its tolerance
  for (const PlaneInRow& row : rows) {
    const SensorRays::RowPlane& plane = row.plane;
    const Float8 cosine = load<8>(row.cosine + column), sine = load<8>(row.sine + column);
    const Float8 denominator = (plane.along * cosine + plane.across * sine) + all<8>(plane.up);
    const Float8 numerator =
        all<8>(plane.at_zero) + plane.side_offset_m * (plane.along * sine - plane.across * cosine);
    const Float8 off = absolute(numerator - load<8>(row.cells.rho_m + column) * denominator);
    farthest = larger(farthest, off - load<8>(row.cells.tolerance_m + column) * denominator);
  }
  return !any(all<8>(0) < farthest);
}

// Along a row, 1 / rho of a plane is a sine of the azimuth: over a tile as good as a line, so that of three
// cells side by side, or equally far apart, the middle one is halfway between the others.
template <std::size_t kApart>
POINTREEL_INLINE Float8 bend_beyond_tolerance(const Float8 (&per_rho)[7], const Float8 (&tolerance)[7],
                                              float curvature) {
  const Float8 bend = absolute((per_rho[0] - per_rho[kApart]) + (per_rho[2 * kApart] - per_rho[kApart]));
  const Float8 most =
      (tolerance[0] + tolerance[2 * kApart]) + (2 * tolerance[kApart] + curvature * per_rho[kApart]);
  static constexpr float kInside[16] = {1, 1, 1, 1, 1, 1, 1, 1};
  return (bend - most) * load<8>(kInside + 2 * kApart);
}

inline bool tile_bends(std::span<const RowCells> rows, std::size_t column, float curvature) {
  Float8 farthest = all<8>(0);
  for (const RowCells& row : rows) {
    Float8 per_rho[7], tolerance[7];
    for (std::size_t right = 0; right < 7; ++right) {
      per_rho[right] = load<8>(row.per_rho_m + column + right);
      const Float8 share = load<8>(row.tolerance_m + column + right) * per_rho[right];
      tolerance[right] = share * per_rho[right];
    }
    farthest = larger(farthest, bend_beyond_tolerance<1>(per_rho, tolerance, curvature));
    farthest = larger(farthest, bend_beyond_tolerance<2>(per_rho, tolerance, curvature));
    farthest = larger(farthest, bend_beyond_tolerance<3>(per_rho, tolerance, curvature));
  }
  return any(all<8>(0) < farthest);
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
