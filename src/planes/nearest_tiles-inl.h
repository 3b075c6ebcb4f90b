// How far patches are from the planes of the tiles nearest to them, eight at once.

#if defined(POINTREEL_PLANES_NEAREST_TILES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PLANES_NEAREST_TILES_INL_H_
#undef POINTREEL_PLANES_NEAREST_TILES_INL_H_
#else
#define POINTREEL_PLANES_NEAREST_TILES_INL_H_
#endif

#include "base/arc_tangent-inl.h"
#include "base/lanes-inl.h"
#include "planes/planes_by_direction.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Of the bins that points lie in; those beyond the outermost bins by up to two.
POINTREEL_INLINE Int8 bins_towards(const Float8& x_m, const Float8& y_m, const Float8& z_m) {
  using Bins = DirectionBins;
  constexpr auto kBinsPerRad = static_cast<float>(Bins::kAcross / kTurn);
  const Float8 rho_m = larger(square_root(x_m * x_m + y_m * y_m), all<8>(0.1F));
  const Int8 across = truncated(kBinsPerRad * (arc_tangent(y_m, x_m) + all<8>(static_cast<float>(kPi)))) &
                      all_ints<8>(Bins::kAcross - 1);
  // Up from 0, so that truncating rounds down.
  const Float8 up = Bins::kBinsPerSlope * (z_m / rho_m - all<8>(Bins::kLowestSlope)) + all<8>(2);
  const Int8 row = truncated(smaller(larger(up, all<8>(0)), all<8>(static_cast<float>(Bins::kUp + 3))));
  return row * all_ints<8>(Bins::kStride) + across + all_ints<8>(Bins::index(0, -2));
}

// Reads and writes whole blocks of eight.
inline void find_bins(std::size_t count, const float* x_m, const float* y_m, const float* z_m,
                      std::int32_t* bins) {
  for (std::size_t i = 0; i < count; i += 8)
    store(bins_towards(load<8>(x_m + i), load<8>(y_m + i), load<8>(z_m + i)), bins + i);
}

// The tile nearest to a point of those whose planes face as `normal` does; -1: there is none.
POINTREEL_INLINE std::int32_t nearest_tile(const PlanesByDirection::Tiles& tiles, std::int32_t bin,
                                           const PatchBlock& block, std::size_t patch, float most_m2) {
  constexpr float kSameDirection = 0.97F;
  static constexpr std::int32_t kLanes[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const Float8 x_m = all<8>(block.x_m[patch]), y_m = all<8>(block.y_m[patch]), z_m = all<8>(block.z_m[patch]);
  const Float8 normal_x = all<8>(block.normal_x[patch]), normal_y = all<8>(block.normal_y[patch]),
               normal_z = all<8>(block.normal_z[patch]);
  Float8 nearest_m2 = all<8>(most_m2);
  Int8 place = all_ints<8>(0);
  const Int8 lanes = load_ints<8>(kLanes);
  for (std::int32_t row = bin - DirectionBins::kStride; row <= bin + DirectionBins::kStride;
       row += DirectionBins::kStride) {
    const std::int32_t end = tiles.first_of_bin[static_cast<std::size_t>(row) + 2];
    for (std::int32_t first = tiles.first_of_bin[static_cast<std::size_t>(row) - 1]; first < end;
         first += 8) {
      const auto i = static_cast<std::size_t>(first);
      const Float8 dx_m = load<8>(&tiles.x_m[i]) - x_m, dy_m = load<8>(&tiles.y_m[i]) - y_m,
                   dz_m = load<8>(&tiles.z_m[i]) - z_m;
      const Float8 away_m2 = (dx_m * dx_m + dy_m * dy_m) + dz_m * dz_m;
      const Float8 alike = (load<8>(&tiles.normal_x[i]) * normal_x + load<8>(&tiles.normal_y[i]) * normal_y) +
                           load<8>(&tiles.normal_z[i]) * normal_z;
      const Mask<8> among = as_float_mask(all_ints<8>(end - first) > lanes);
      const Mask<8> nearer = among & (away_m2 < nearest_m2) & (all<8>(kSameDirection) < alike);
      nearest_m2 = select(nearer, away_m2, nearest_m2);
      place = select(as_int_mask(nearer), all_ints<8>(first), place);
    }
  }
  const float least_m2 = smallest(nearest_m2);
  if (!(least_m2 < most_m2)) return -1;
  const std::size_t lane = first_lane_with(nearest_m2, least_m2);
  std::int32_t places[8];
  store(place, places);
  return places[lane] + static_cast<std::int32_t>(lane);
}

inline void measure_to_planes(const PlanesByDirection::Tiles& tiles, PatchBlock& block) {
  constexpr float kFarthestShare = 0.1F, kFarthestM = 0.5F;  // of a tile's center from the point
  for (std::size_t i = 0; i < block.count; i += 8) {
    const Float8 x_m = load<8>(&block.x_m[i]), y_m = load<8>(&block.y_m[i]), z_m = load<8>(&block.z_m[i]);
    const Float8 most_m =
        kFarthestShare * square_root((x_m * x_m + y_m * y_m) + z_m * z_m) + all<8>(kFarthestM);
    std::int32_t bins[8], nearest[8];
    float most_m2[8];
    store(bins_towards(x_m, y_m, z_m), bins);
    store(most_m * most_m, most_m2);
    for (std::size_t lane = 0; lane < 8; ++lane)
      nearest[lane] = nearest_tile(tiles, bins[lane], block, i + lane, most_m2[lane]);
    const Int8 found = load_ints<8>(nearest);
    const Int8 tile = larger(found, all_ints<8>(0));
    const Float8 normal_x = gather(tiles.normal_x.data(), tile),
                 normal_y = gather(tiles.normal_y.data(), tile),
                 normal_z = gather(tiles.normal_z.data(), tile);
    const Float8 above_m =
        ((normal_x * x_m + normal_y * y_m) + normal_z * z_m) - gather(tiles.distance_m.data(), tile);
    const Float8 alike = (normal_x * load<8>(&block.normal_x[i]) + normal_y * load<8>(&block.normal_y[i])) +
                         normal_z * load<8>(&block.normal_z[i]);
    const Mask<8> none = as_float_mask(all_ints<8>(0) > found);
    store(select(none, all<8>(PatchBlock::kNoPartner), above_m * alike), &block.distance_m[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
