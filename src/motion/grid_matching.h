// What registration does with each cell of a sweep's grid, in SIMD code.
#pragma once

#include <optional>

#include "motion/patch_block.h"
#include "motion/range_grid.h"

namespace pointreel {

// Fills the distances: those of the returns most nearly as far away as the patches, of the cells that look
// towards these or just beside them.
void measure_patches(const GridRays& reference, PatchBlock& block);

// Cells to each side of a patch's center: narrow things such as posts tell best how far the sensor went.
inline constexpr int kHalfPatchColumns = 2;
inline constexpr int kMostHalfPatchRows = 2;

// The plane through a cell's neighbours, `half_rows` rows up and down; none: they are not flat, or too few.
std::optional<SurfacePatch> patch_around(const GridRays& sweep, int row, int column, int half_rows);

}  // namespace pointreel
