// The warped reference around the cells of one step of the wavefront, eight at once.

#if defined(POINTREEL_PREDICT_REFERENCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_REFERENCE_INL_H_
#undef POINTREEL_PREDICT_REFERENCE_INL_H_
#else
#define POINTREEL_PREDICT_REFERENCE_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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
    const auto columns = static_cast<std::size_t>(image.columns);
    const std::vector<float> no_range_m(columns);
    const std::vector<std::uint8_t> no_hits(columns);
    for (int row = -SkewedPlane<float>::kRowsAbove; row < Wavefront::kRows + SkewedPlane<float>::kRowsBelow;
         ++row) {
      const int image_row = first_row + row;
      const bool inside = image_row >= 0 && image_row < image.rows;
      const std::size_t first = inside ? image.index(image_row, 0) : 0;
      range_m.set_row(row,
                      std::span<const float>(inside ? &image.range_m[first] : no_range_m.data(), columns));
      hits.set_row(row, std::span<const std::uint8_t>(inside ? &image.hits[first] : no_hits.data(), columns));
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
