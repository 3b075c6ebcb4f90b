// MovedPlanes: what the planes of an earlier sweep say about the tiles of this one.
#pragma once

#include <cstdint>
#include <vector>

#include "planes/plane_tiles.h"
#include "pointreel/motion.h"

namespace pointreel {

// In the coordinates of this sweep. The same on every machine.
struct MovedPlanes {
  std::vector<Plane> planes;                // of each plane of the earlier sweep
  std::vector<std::int32_t> plane_of_tile;  // by tile of this sweep: the nearest there, -1: none

  // None of anything, for frames by themselves.
  MovedPlanes() = default;
  MovedPlanes(const SensorRays& reference_rays, const PlaneTiles& reference, const Pose& T_ref_cur,
              const SensorRays& rays, const TileGrid& tiles);

  // That of a tile, or nullptr.
  const Plane* at(const TileGrid& tiles, int tile_row, int tile) const {
    const std::int32_t plane = plane_of_tile.empty() ? -1 : plane_of_tile[tiles.index(tile_row, tile)];
    return plane < 0 ? nullptr : &planes[static_cast<std::size_t>(plane)];
  }
};

}  // namespace pointreel
