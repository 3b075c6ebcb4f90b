// The warped reference around the cells of one step of the wavefront, eight at once.

#if defined(POINTREEL_PREDICT_REFERENCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_REFERENCE_INL_H_
#undef POINTREEL_PREDICT_REFERENCE_INL_H_
#else
#define POINTREEL_PREDICT_REFERENCE_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "base/lanes-inl.h"
#include "predict/reference_image.h"
#include "predict/wavefront.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// The part of a reference image around a block of rows.
class ReferencePlanes {
 public:
  explicit ReferencePlanes(int columns) : range_m(columns), hits(columns) {}

  // `first_row`: of the block, in the image; rows beyond it are empty.
  HWY_NOINLINE void load_block(const ReferenceImage& image, int first_row) {
    constexpr std::ptrdiff_t kPitch = SkewedPlane<float>::kPitch;
    for (int row = -SkewedPlane<float>::kRowsAbove; row < Wavefront::kRows + SkewedPlane<float>::kRowsBelow;
         ++row) {
      const int image_row = first_row + row;
      float* range_to = range_m.row(row);
      std::int32_t* hits_to = hits.row(row);
      if (image_row < 0 || image_row >= image.rows) {
        for (int column = 0; column < image.columns; ++column) {
          range_to[column * kPitch] = 0;
          hits_to[column * kPitch] = 0;
        }
      } else {
        const float* range_from = &image.range_m[image.index(image_row, 0)];
        const std::uint8_t* hits_from = &image.hits[image.index(image_row, 0)];
        for (int column = 0; column < image.columns; ++column) {
          range_to[column * kPitch] = range_from[column];
          hits_to[column * kPitch] = hits_from[column];
        }
      }
    }
  }

  SkewedPlane<float> range_m;
  SkewedPlane<std::int32_t> hits;  // HitReference bits
};

class ReferenceView {
 public:
  POINTREEL_INLINE ReferenceView(const ReferencePlanes& planes, int step) : planes_(planes), step_(step) {}

  // Columns to the right of the cell (within the margin), rows below it (-2 to 1).
  POINTREEL_INLINE Float8 range_m(int columns_right, int rows_down = 0) const {
    return load<8>(planes_.range_m.at(step_, columns_right, rows_down));
  }
  POINTREEL_INLINE Int8 hits(int columns_right, int rows_down = 0) const {
    return load_ints<8>(planes_.hits.at(step_, columns_right, rows_down));
  }

 private:
  const ReferencePlanes& planes_;
  int step_;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
