#include "planes/tile_tests.h"

#include "base/simd_targets.h"

#define HWY_TARGET_INCLUDE "planes/tile_tests.cpp"
#include "hwy/foreach_target.h"
//
#include "planes/tile_tests-inl.h"

#if HWY_ONCE
namespace pointreel {
namespace {

HWY_EXPORT(tile_holds);
HWY_EXPORT(tile_bends);

}  // namespace

bool tile_holds(std::span<const PlaneInRow> rows, std::size_t column) {
  return HWY_DYNAMIC_DISPATCH(tile_holds)(rows, column);
}

bool tile_bends(std::span<const RowCells> rows, std::size_t column) {
  return HWY_DYNAMIC_DISPATCH(tile_bends)(rows, column);
}

}  // namespace pointreel
#endif
