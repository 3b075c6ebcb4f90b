#include "planes/moved_planes.h"

namespace pointreel {

MovedPlanes::MovedPlanes(const SensorRays& reference_rays, const PlaneTiles& reference, const Pose& T_ref_cur,
                         const SensorRays& rays, const TileGrid& tiles)
    : plane_of_tile(tiles.count(), -1) {
  const Eigen::Matrix3d r = T_ref_cur.linear();
  const Eigen::Vector3d t = T_ref_cur.translation();
  // n.(R p + t) = 1; written out, so that the order of operations is the same everywhere.
  const auto turned_back = [&r](int i, double x, double y, double z) {
    return (r(0, i) * x + r(1, i) * y) + r(2, i) * z;
  };
  for (const TilePlane& tile_plane : reference.planes) {
    const auto& [x, y, z] = tile_plane.plane;
    const double beyond = 1 - ((x * t(0) + y * t(1)) + z * t(2));
    planes.push_back({turned_back(0, x, y, z) / beyond, turned_back(1, x, y, z) / beyond,
                      turned_back(2, x, y, z) / beyond});
  }

  std::vector<double> nearest_m(tiles.count(), 1e9);
  for (int tile_row = 0; tile_row < reference.tiles.down; ++tile_row) {
    for (int tile = 0; tile < reference.tiles.across; ++tile) {
      const std::int32_t plane = reference.plane_of_tile[reference.tiles.index(tile_row, tile)];
      if (plane < 0) continue;
      const auto at = frame_of_tile(reference_rays, reference.tiles, tile_row, tile, 0).at;
      const auto& [nx, ny, nz] = reference.planes[static_cast<std::size_t>(plane)].plane;
      const double rho_m = (1 - nz * at.offset_m) / ((nx * at.cos + ny * at.sin) + nz * at.slope);
      const double x = rho_m * at.cos - t(0), y = rho_m * at.sin - t(1),
                   z = (rho_m * at.slope + at.offset_m) - t(2);
      const auto cell =
          rays.cell_towards(turned_back(0, x, y, z), turned_back(1, x, y, z), turned_back(2, x, y, z),
                            std::min(TileGrid::first_row(tile_row), rays.rows() - 1));
      if (!cell) continue;
      const std::size_t index = tiles.index(cell->row / kTileRows, cell->column / kTileColumns);
      if (!(rho_m < nearest_m[index])) continue;
      nearest_m[index] = rho_m;
      plane_of_tile[index] = plane;
    }
  }
  // Surfaces go on between.
  const std::vector<std::int32_t> seen = plane_of_tile;
  for (int tile_row = 0; tile_row < tiles.down; ++tile_row) {
    for (int tile = 0; tile < tiles.across; ++tile) {
      std::int32_t& plane = plane_of_tile[tiles.index(tile_row, tile)];
      if (plane >= 0) continue;
      if (tile > 0) plane = seen[tiles.index(tile_row, tile - 1)];
      if (plane < 0 && tile + 1 < tiles.across) plane = seen[tiles.index(tile_row, tile + 1)];
      if (plane < 0 && tile_row > 0) plane = seen[tiles.index(tile_row - 1, tile)];
      if (plane < 0 && tile_row + 1 < tiles.down) plane = seen[tiles.index(tile_row + 1, tile)];
    }
  }
}

}  // namespace pointreel
