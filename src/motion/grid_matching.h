// What registration does with each cell of a sweep's grid, in SIMD code.
#pragma once

#include <algorithm>
#include <optional>

#include "motion/patch_block.h"
#include "motion/range_grid.h"

namespace pointreel {

// Fills the distances: means over the returns of the cells that look towards the patches or just beside them,
// kHalfPatchColumns to each side and, where rows are many, a row up and down.
void measure_patches(const GridRays& reference, PatchBlock& block);

// Cells to each side of a patch's center: narrow things such as posts tell best how far the sensor went.
inline constexpr int kHalfPatchColumns = 2;
// At most; one where rows are few, and far apart.
inline constexpr int kMostHalfPatchRows = 2;
inline int half_patch_rows(const GridRays& sweep) {
  return std::clamp(sweep.row_count() / 24, 1, kMostHalfPatchRows);
}

// The plane through a cell's neighbours, `half_rows` rows up and down; none: they are not flat, or too few.
std::optional<SurfacePatch> patch_around(const GridRays& sweep, int row, int column, int half_rows);

}  // namespace pointreel
