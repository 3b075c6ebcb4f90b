#include "planes/plane_tiles_coding.h"

#include <algorithm>
#include <array>
#include <optional>

#include "entropy/adaptive_models.h"

namespace pointreel {
namespace {

// 0 to kExtentClasses - 1.
class AdaptiveClass {
 public:
  template <class Coder>
  int code(Coder& coder, int value) {
    int coded = 0;
    while (coded + 1 < kExtentClasses && coder.code(more_[static_cast<std::size_t>(coded)], value > coded))
      ++coded;
    return coded;
  }

 private:
  std::array<AdaptiveBit, kExtentClasses> more_;
};

// Tile by tile in raster order: is it on a plane, on that of a neighbour, or on a new one? A decoder passes
// planes without any, all tiles on none.
template <class Coder>
class PlaneTilesCoder {
 public:
  PlaneTilesCoder(Coder& coder, const SensorRays& rays, double step_m, const MovedPlanes& earlier)
      : coder_(coder), rays_(rays), step_m_(step_m), earlier_(earlier) {}

  // False when a decoder runs out of bytes.
  bool code(PlaneTiles& planes) {
    const TileGrid& tiles = planes.tiles;
    std::int32_t known = 0;  // planes
    for (int tile_row = 0; tile_row < tiles.down; ++tile_row) {
      for (int tile = 0; tile < tiles.across; ++tile) {
        const NeighbourPlanes around(planes, tile_row, tile);
        std::int32_t& plane = planes.plane_of_tile[tiles.index(tile_row, tile)];
        plane = code_label(around, known, plane);
        if (plane < known) continue;
        if constexpr (Coder::kDecodes) planes.planes.emplace_back();
        code_plane(around, planes, tile_row, tile, planes.planes[static_cast<std::size_t>(known)]);
        ++known;
      }
      if constexpr (Coder::kDecodes) {
        if (coder_.overran()) return false;
      }
    }
    return true;
  }

 private:
  // Gives back a plane that is known, -1, or `known` for the next one.
  std::int32_t code_label(const NeighbourPlanes& around, std::int32_t known, std::int32_t wanted) {
    const auto [left, above, above_right, above_left] = around;
    const auto candidates = around.distinct();
    const auto yes = [](bool condition) { return condition ? std::size_t{1} : std::size_t{0}; };
    const std::size_t on =
        yes(left >= 0) | yes(above >= 0) << 1 | yes(above_right >= 0) << 2 | yes(above_left >= 0) << 3;
    const std::size_t same = yes(left >= 0 && above == left) | yes(above >= 0 && above_left == above) << 1 |
                             yes(above >= 0 && above_right == above) << 2;
    if (!coder_.code(on_plane_[on * 8 + same], wanted >= 0)) return -1;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i] >= 0 && coder_.code(goes_on_[i][on * 8 + same], wanted == candidates[i]))
        return candidates[i];
    }
    return known;
  }

  void code_plane(const NeighbourPlanes& around, const PlaneTiles& planes, int tile_row, int tile,
                  TilePlane& plane) {
    if (code_reused(planes, tile_row, tile, plane)) return;
    plane.width = static_cast<std::uint8_t>(width_.code(coder_, plane.width));
    const PlaneFrame frame = frame_of_tile(rays_, planes.tiles, tile_row, tile, plane.width);
    const PredictedLevels predicted = predict(around, planes, frame);
    for (std::size_t i = 0; i < plane.levels.size(); ++i) {
      const std::int32_t difference =
          level_[predicted.quality][i].code(coder_, plane.levels[i] - predicted.levels[i]);
      const std::int64_t level = std::int64_t{predicted.levels[i]} + difference;
      plane.levels[i] = static_cast<std::int32_t>(
          std::clamp<std::int64_t>(level, i == 0 ? 1 : -kMostPlaneLevel, kMostPlaneLevel));
    }
    last_rho_m_ = plane.levels[0] * step_m_;
    plane.plane = plane_from_levels(frame, plane.levels, step_m_);
  }

  // An earlier sweep's plane at a new distance.
  bool code_reused(const PlaneTiles& planes, int tile_row, int tile, TilePlane& plane) {
    const Plane* earlier = earlier_.at(planes.tiles, tile_row, tile);
    if (earlier == nullptr) return false;
    const PlaneFrame frame = frame_of_tile(rays_, planes.tiles, tile_row, tile, 0);
    const auto level = distance_level(frame, *earlier, step_m_);
    if (!level || !coder_.code(reused_, plane.reused)) return false;
    plane.reused = true;
    const std::int64_t shifted = std::int64_t{*level} + shift_.code(coder_, plane.levels[0] - *level);
    plane.levels = {static_cast<std::int32_t>(std::clamp<std::int64_t>(shifted, 1, kMostPlaneLevel)), 0, 0};
    plane.plane = plane_at_distance(frame, *earlier, plane.levels[0], step_m_);
    last_rho_m_ = plane.levels[0] * step_m_;
    return true;
  }

  struct PredictedLevels {
    PlaneLevels levels;
    std::size_t quality;
  };
  // The plane of a neighbour goes on; without one, the distance is that of the last plane.
  PredictedLevels predict(const NeighbourPlanes& around, const PlaneTiles& planes,
                          const PlaneFrame& frame) const {
    std::size_t quality = 0;
    for (const std::int32_t index : {around.left, around.above, around.above_right}) {
      if (index >= 0) {
        const Plane& plane = planes.planes[static_cast<std::size_t>(index)].plane;
        if (const auto levels = levels_of_plane(frame, plane, step_m_)) return {*levels, quality};
      }
      ++quality;
    }
    const double level = std::clamp(last_rho_m_ / step_m_ + 0.5, 1.0, double{kMostPlaneLevel});
    return {{static_cast<std::int32_t>(level), 0, 0}, quality};
  }

  Coder& coder_;
  const SensorRays& rays_;
  double step_m_;
  const MovedPlanes& earlier_;
  double last_rho_m_ = 10;
  std::array<AdaptiveBit, 128> on_plane_;
  std::array<std::array<AdaptiveBit, 128>, 3> goes_on_;  // by which neighbour's plane
  AdaptiveBit reused_;
  AdaptiveInteger shift_;
  AdaptiveClass width_;
  std::array<std::array<AdaptiveInteger, 3>, 4> level_;  // by what predicts them
};

}  // namespace

std::vector<std::uint8_t> encode_plane_tiles(const SensorRays& rays, double step_m,
                                             const MovedPlanes& earlier, const PlaneTiles& planes) {
  BitEncoder coder;
  PlaneTiles coded = planes;
  PlaneTilesCoder<BitEncoder>(coder, rays, step_m, earlier).code(coded);
  return coder.finish();
}

Result<PlaneTiles> decode_plane_tiles(const SensorRays& rays, double step_m, const MovedPlanes& earlier,
                                      std::span<const std::uint8_t> bytes) {
  PlaneTiles planes;
  planes.tiles = TileGrid(rays.rows(), rays.columns());
  planes.plane_of_tile.assign(planes.tiles.count(), -1);
  BitDecoder coder(bytes);
  if (!PlaneTilesCoder<BitDecoder>(coder, rays, step_m, earlier).code(planes))
    return Error{ErrorCode::truncated, "it ends within its planes"};
  return planes;
}

}  // namespace pointreel
