// Least-squares fits in inverse range around a cell, from the cells before it; eight cells at once.
//
// Along a plane, 1/range is linear in the tangents of the angles, so over a few cells nearly linear in row
// and column. Cells count when their range is similar to a reference: the surface that is meant.

#if defined(POINTREEL_PREDICT_LOCAL_FITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_LOCAL_FITS_INL_H_
#undef POINTREEL_PREDICT_LOCAL_FITS_INL_H_
#else
#define POINTREEL_PREDICT_LOCAL_FITS_INL_H_
#endif

#include "predict/fit_kernels.h"
#include "predict/neighbourhood-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Inverse ranges; 0 where too few cells are similar.
struct LocalFits {
  Float8 plane;     // plane through the cells left and in the two rows above
  Float8 line;      // line through the cells left
  Float8 parallel;  // cell above, plus the mean step from the row above to this one left of the cell

  POINTREEL_INLINE LocalFits() {}
};

// Cells are similar within a few per cent, and 0.3 m for near ones.
struct Similarity {
  Float8 reference_m, tolerance_m;

  POINTREEL_INLINE explicit Similarity(const Float8& reference)
      : reference_m(reference), tolerance_m(0.03F * reference + all<8>(0.3F)) {}
  POINTREEL_INLINE Mask<8> operator()(const Float8& range_m) const {
    return (absolute(range_m - reference_m) <= tolerance_m) & seen(range_m);
  }
};

// Sums of one row over the similar cells: w, w x, w x^2, w u, w x u.
struct RowSums {
  Float8 w, wx, wxx, wu, wxu;

  POINTREEL_INLINE RowSums() : w(all<8>(0)), wx(w), wxx(w), wu(w), wxu(w) {}
  POINTREEL_INLINE void add(const Mask<8>& counts, float weight, float x, const Float8& u) {
    w = w + where(counts, all<8>(weight));
    wx = wx + where(counts, all<8>(weight * x));
    wxx = wxx + where(counts, all<8>(weight * x * x));
    const Float8 weighted = where(counts, weight * u);
    wu = wu + weighted;
    wxu = wxu + x * weighted;
  }
};

// The plane's value at the cell itself, from u = a + b x + c y, by Cramer's rule for a; y counts rows
// downwards, kY columns a row.
POINTREEL_INLINE Float8 plane_at_cell(const RowSums& here, const RowSums& above, const RowSums& above2,
                                      const Float8& offset) {
  constexpr float kRidge = 1e-2F;  // keeps slopes small where they cannot be told
  constexpr float kSmallestDeterminant = 1e-9F;
  constexpr float kY = kFitColumnsPerRow;
  const Float8 m00 = here.w + (above.w + above2.w);
  const Float8 m01 = here.wx + (above.wx + above2.wx);
  const Float8 m02 = -kY * (above.w + 2 * above2.w);
  const Float8 m11 = here.wxx + (above.wxx + above2.wxx) + all<8>(kRidge);
  const Float8 m12 = -kY * (above.wx + 2 * above2.wx);
  const Float8 m22 = (kY * kY) * (above.w + 4 * above2.w) + all<8>(kRidge);
  const Float8 v0 = here.wu + (above.wu + above2.wu);
  const Float8 v1 = here.wxu + (above.wxu + above2.wxu);
  const Float8 v2 = -kY * (above.wu + 2 * above2.wu);
  const Float8 minor0 = m11 * m22 - m12 * m12;
  const Float8 minor1 = v1 * m22 - m12 * v2;
  const Float8 minor2 = v1 * m12 - m11 * v2;
  const Float8 determinant = m00 * minor0 - m01 * (m01 * m22 - m12 * m02) + m02 * (m01 * m12 - m11 * m02);
  const Float8 value =
      (v0 * minor0 - m01 * minor1 + m02 * minor2) / larger(determinant, all<8>(kSmallestDeterminant));
  return where(all<8>(kSmallestDeterminant) <= determinant, value + offset);
}

// `reference_m`: range of the surface, `above_m`: range of the cells above or 0.
HWY_NOINLINE inline LocalFits fit_locally(const Neighbourhood& cells, const Float8& reference_m,
                                          const Float8& above_m) {
  const FitKernels& kernels = kFitKernels;
  const Similarity similar(reference_m);
  const Similarity similar_above(above_m);
  const Float8 inverse_reference = all<8>(1) / reference_m;
  RowSums here, above, above2;
  Float8 parallel_weight = all<8>(0), parallel_step = all<8>(0);
  for (int i = 0; i < FitKernels::kHere; ++i) {
    const int column = FitKernels::kFirstHere + i;
    const auto x = static_cast<float>(column);
    const Float8 inverse = cells.inverse_range(column);
    const Mask<8> counts = similar(cells.range_m(column));
    const Float8 u = inverse - inverse_reference;
    here.add(counts, kernels.here[i], x, u);
    const Float8 both = where(counts & similar_above(cells.range_m(column, -1)), all<8>(kernels.here[i]));
    parallel_weight = parallel_weight + both;
    parallel_step = parallel_step + both * (inverse - cells.inverse_range(column, -1));
  }
  for (int i = 0; i < FitKernels::kAbove; ++i) {
    const int column = FitKernels::kFirstAbove + i;
    const auto x = static_cast<float>(column);
    above.add(similar(cells.range_m(column, -1)), kernels.above[i], x,
              cells.inverse_range(column, -1) - inverse_reference);
    above2.add(similar(cells.range_m(column, -2)), kernels.above2[i], x,
               cells.inverse_range(column, -2) - inverse_reference);
  }
  LocalFits fits;
  fits.plane = plane_at_cell(here, above, above2, inverse_reference);
  {
    constexpr float kSmallestDeterminant = 1e-9F;
    const Float8 wxx = here.wxx + all<8>(0.5F);
    const Float8 determinant = here.w * wxx - here.wx * here.wx;
    const Float8 value =
        (here.wu * wxx - here.wxu * here.wx) / larger(determinant, all<8>(kSmallestDeterminant));
    fits.line = where(all<8>(kSmallestDeterminant) <= determinant, value + inverse_reference);
  }
  const Mask<8> has_parallel = seen(above_m) & (all<8>(1e-3F) <= parallel_weight);
  fits.parallel = where(has_parallel,
                        cells.inverse_range(0, -1) + parallel_step / larger(parallel_weight, all<8>(1e-3F)));
  return fits;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
