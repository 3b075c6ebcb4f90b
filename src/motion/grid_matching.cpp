#include "motion/grid_matching.h"

// As in band_coding.cpp.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#define HWY_TARGET_INCLUDE "motion/grid_matching.cpp"
#include "hwy/foreach_target.h"
//
#include "motion/patch_measuring-inl.h"
#include "motion/patch_planes-inl.h"

#if HWY_ONCE
namespace pointreel {

HWY_EXPORT(measure);
HWY_EXPORT(plane_around);

void measure_patches(const GridRays& reference, PatchBlock& block) {
  if (reference.row_count() == 0) {
    block.distance_m.fill(PatchBlock::kNoPartner);
    return;
  }
  HWY_DYNAMIC_DISPATCH(measure)(reference, block);
}

std::optional<SurfacePatch> patch_around(const GridRays& sweep, int row, int column, int half_rows) {
  SurfacePatch patch;
  if (!HWY_DYNAMIC_DISPATCH(plane_around)(sweep, row, column, half_rows, patch)) return std::nullopt;
  return patch;
}

}  // namespace pointreel
#endif  // HWY_ONCE
