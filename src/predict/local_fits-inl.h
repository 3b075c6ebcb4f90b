// Least-squares fits in inverse range around a cell, from the cells before it.
//
// Along a plane, 1/range is linear in the tangents of the angles, so over a few cells nearly linear in row
// and column. Cells count when their range is similar to a reference: the surface that is meant.

#if defined(POINTREEL_PREDICT_LOCAL_FITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_LOCAL_FITS_INL_H_
#undef POINTREEL_PREDICT_LOCAL_FITS_INL_H_
#else
#define POINTREEL_PREDICT_LOCAL_FITS_INL_H_
#endif

#include "predict/causal_canvas.h"
#include "predict/fit_kernels.h"
#include "predict/float16-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Inverse ranges; 0 where too few cells are similar.
struct LocalFits {
  float plane = 0;     // plane through the cells left and in the two rows above
  float line = 0;      // line through the cells left
  float parallel = 0;  // cell above, plus the mean step from the row above to this one left of the cell
};

// Cells are similar within a few per cent, and 0.3 m for near ones.
HWY_INLINE Mask<8> similar(const Float8& range_m, float reference_m) {
  return (absolute(range_m - all<8>(reference_m)) <= all<8>(0.03F * reference_m + 0.3F)) &
         (all<8>(CausalCanvas::kSmallestRangeM) <= range_m);
}

// `reference_m`: range of the surface, `above_m`: range of the cell above or 0.
HWY_INLINE LocalFits fit_locally(const CausalCanvas& canvas, std::size_t index, float reference_m,
                                 float above_m) {
  constexpr float kRidge = 1e-2F;  // keeps slopes small where they cannot be told
  constexpr float kSmallestDeterminant = 1e-9F;
  static_assert(FitKernels::kLanes == 8);
  const FitKernels& kernels = kFitKernels;
  const std::size_t first = index + static_cast<std::size_t>(FitKernels::kFirstHere);
  const std::size_t above = index - canvas.stride() + static_cast<std::size_t>(FitKernels::kFirstAbove);
  const std::size_t above2 = above - canvas.stride();
  const float inverse_reference = 1 / reference_m;
  const Float8 from_reference = all<8>(inverse_reference);

  const Float8 inverse_here = load<8>(canvas.inverse_range(first));
  const Mask<8> similar_here = similar(load<8>(canvas.range_m(first)), reference_m);
  const Float8 u = inverse_here - from_reference;
  const Float8 x = load<8>(kernels.x_here);
  LocalFits fits;
  {
    // Normal equations of u = a + b x + c y, by Cramer's rule for a; y counts rows downwards.
    const Float8 w0 = where(similar_here, load<8>(kernels.plane_here));
    const Float8 w1 =
        where(similar(load<8>(canvas.range_m(above)), reference_m), load<8>(kernels.plane_above));
    const Float8 w2 =
        where(similar(load<8>(canvas.range_m(above2)), reference_m), load<8>(kernels.plane_above2));
    const Float8 x_above = load<8>(kernels.x_above);
    const Float8 w12 = w1 + w2;
    const Float8 wx0 = w0 * x, wx12 = w12 * x_above;
    const Float8 wu0 = w0 * u;
    const Float8 wu1 = w1 * (load<8>(canvas.inverse_range(above)) - from_reference);
    const Float8 wu2 = w2 * (load<8>(canvas.inverse_range(above2)) - from_reference);
    const Float8 wu12 = wu1 + wu2;
    constexpr float kY = FitKernels::kColumnsPerRow;
    const Float8 wy = w12 + w2;  // in units of -kY
    const float m00 = sum(w0 + w12);
    const float m01 = sum(wx0 + wx12);
    const float m02 = -kY * sum(wy);
    const float m11 = sum(wx0 * x + wx12 * x_above) + kRidge;
    const float m12 = -kY * sum(wy * x_above);
    const float m22 = kY * kY * sum(wy + w2 + w2) + kRidge;
    const float v0 = sum(wu0 + wu12);
    const float v1 = sum(wu0 * x + wu12 * x_above);
    const float v2 = -kY * sum(wu12 + wu2);
    const float minor0 = m11 * m22 - m12 * m12;
    const float minor1 = v1 * m22 - m12 * v2;
    const float minor2 = v1 * m12 - m11 * v2;
    const float determinant = m00 * minor0 - m01 * (m01 * m22 - m12 * m02) + m02 * (m01 * m12 - m11 * m02);
    if (m00 > 0 && determinant > kSmallestDeterminant) {
      fits.plane = (v0 * minor0 - m01 * minor1 + m02 * minor2) / determinant + inverse_reference;
    }
  }
  {
    const Float8 w = where(similar_here, load<8>(kernels.line));
    const Float8 wx = w * x, wu = w * u;
    const float m0 = sum(w), m1 = sum(wx), m2 = sum(wx * x) + 0.5F;
    const float determinant = m0 * m2 - m1 * m1;
    if (m0 > 0 && determinant > kSmallestDeterminant) {
      fits.line = (sum(wu) * m2 - sum(wu * x) * m1) / determinant + inverse_reference;
    }
  }
  if (above_m > 0) {
    const std::size_t first_above = first - canvas.stride();
    const Float8 w =
        where(similar_here & similar(load<8>(canvas.range_m(first_above)), above_m), load<8>(kernels.line));
    const float total = sum(w);
    if (total > 0) {
      fits.parallel =
          1 / above_m + sum(w * (inverse_here - load<8>(canvas.inverse_range(first_above)))) / total;
    }
  }
  return fits;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
