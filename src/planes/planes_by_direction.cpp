#include "planes/planes_by_direction.h"

#include <limits>
#include <numeric>

#include "base/simd_targets.h"

#define HWY_TARGET_INCLUDE "planes/planes_by_direction.cpp"
#include "hwy/foreach_target.h"
//
#include "planes/nearest_tiles-inl.h"

#if HWY_ONCE
namespace pointreel {
namespace {

HWY_EXPORT(find_bins);
HWY_EXPORT(measure_to_planes);

std::vector<std::int32_t> bins_of(const std::vector<PlaneTile>& tiles) {
  const std::size_t padded = tiles.size() + PlanesByDirection::kAtOnce;
  std::vector<float> x_m(padded), y_m(padded), z_m(padded);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    x_m[i] = tiles[i].center_m.x();
    y_m[i] = tiles[i].center_m.y();
    z_m[i] = tiles[i].center_m.z();
  }
  std::vector<std::int32_t> bins(padded);
  HWY_DYNAMIC_DISPATCH(find_bins)(tiles.size(), x_m.data(), y_m.data(), z_m.data(), bins.data());
  bins.resize(tiles.size());
  return bins;
}

// The bin, and beyond the seam the same once more.
template <class Use>
void for_each_copy(std::int32_t bin, const Use& use) {
  const std::int32_t across = bin % DirectionBins::kStride - 1;
  use(static_cast<std::size_t>(bin));
  if (across == 0) use(static_cast<std::size_t>(bin + DirectionBins::kAcross));
  if (across == DirectionBins::kAcross - 1) use(static_cast<std::size_t>(bin - DirectionBins::kAcross));
}

}  // namespace

PlanesByDirection::PlanesByDirection(const SweepPlanes& sweep) {
  const auto bins = bins_of(sweep.tiles);
  auto& first = tiles_.first_of_bin;
  first.resize(static_cast<std::size_t>(DirectionBins::kCount) + 1);
  for (const std::int32_t bin : bins) for_each_copy(bin, [&](std::size_t copy) { ++first[copy + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());

  const std::size_t padded = static_cast<std::size_t>(first.back()) + kAtOnce;
  for (auto* centers : {&tiles_.x_m, &tiles_.y_m, &tiles_.z_m})
    centers->resize(padded, std::numeric_limits<float>::infinity());
  for (auto* planes : {&tiles_.normal_x, &tiles_.normal_y, &tiles_.normal_z, &tiles_.distance_m})
    planes->resize(padded);
  std::vector<std::int32_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Eigen::Vector3f& center_m = sweep.tiles[i].center_m;
    const SweepPlane& plane = sweep.planes[sweep.tiles[i].plane];
    const Eigen::Vector3f normal = plane.normal.cast<float>();
    for_each_copy(bins[i], [&](std::size_t copy) {
      const auto place = static_cast<std::size_t>(next[copy]++);
      tiles_.x_m[place] = center_m.x();
      tiles_.y_m[place] = center_m.y();
      tiles_.z_m[place] = center_m.z();
      tiles_.normal_x[place] = normal.x();
      tiles_.normal_y[place] = normal.y();
      tiles_.normal_z[place] = normal.z();
      tiles_.distance_m[place] = static_cast<float>(plane.distance_m);
    });
  }
}

void PlanesByDirection::measure(PatchBlock& block) const {
  HWY_DYNAMIC_DISPATCH(measure_to_planes)(tiles_, block);
}

}  // namespace pointreel
#endif  // HWY_ONCE
