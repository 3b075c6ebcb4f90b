#include "motion/grid_matching.h"

#include "base/simd_targets.h"

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
  if (reference.row_count() == 0 || reference.column_count() <= 2 * kHalfPatchColumns) {
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
