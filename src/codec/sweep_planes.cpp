#include "codec/sweep_planes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointreel {
namespace {

Eigen::Vector3d center_of(const SensorRays::Direction& at, const Plane& plane) {
  const double rho_m =
      (1 - plane.z * at.offset_m) / ((plane.x * at.cos + plane.y * at.sin) + plane.z * at.slope);
  return {rho_m * at.cos, rho_m * at.sin, rho_m * at.slope + at.offset_m};
}

// Axes along which the tiles of each plane spread most and least.
void measure_extents(SweepPlanes& sweep) {
  std::vector<Eigen::Matrix3d> spread(sweep.planes.size(), Eigen::Matrix3d::Zero());
  for (const PlaneTile& tile : sweep.tiles) {
    const Eigen::Vector3d off_m = tile.center_m.cast<double>() - sweep.planes[tile.plane].center_m;
    spread[tile.plane] += off_m * off_m.transpose();
  }
  constexpr double kMost = std::numeric_limits<double>::max();
  std::vector<Eigen::Vector4d> ends(sweep.planes.size(), {kMost, -kMost, kMost, -kMost});
  for (std::size_t i = 0; i < sweep.planes.size(); ++i) {
    SweepPlane& plane = sweep.planes[i];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread[i]);
    const Eigen::Vector3d most = solver.eigenvectors().col(2);
    const Eigen::Vector3d along = most - plane.normal * plane.normal.dot(most);
    plane.long_axis =
        along.norm() > 1e-6 ? Eigen::Vector3d(along.normalized()) : plane.normal.unitOrthogonal();
    plane.short_axis = plane.normal.cross(plane.long_axis);
  }
  for (const PlaneTile& tile : sweep.tiles) {
    const SweepPlane& plane = sweep.planes[tile.plane];
    const Eigen::Vector3d off_m = tile.center_m.cast<double>() - plane.center_m;
    const double along_m = off_m.dot(plane.long_axis), across_m = off_m.dot(plane.short_axis);
    Eigen::Vector4d& end = ends[tile.plane];
    end = {std::min(end[0], along_m), std::max(end[1], along_m), std::min(end[2], across_m),
           std::max(end[3], across_m)};
  }
  for (std::size_t i = 0; i < sweep.planes.size(); ++i) {
    sweep.planes[i].length_m = ends[i][1] - ends[i][0];
    sweep.planes[i].width_m = ends[i][3] - ends[i][2];
  }
}

}  // namespace

SweepPlanes sweep_planes_of(std::uint32_t frame, const SensorRays& rays, const PlaneTiles& planes) {
  constexpr double kFarthestM = 1e5;
  SweepPlanes sweep;
  sweep.frame = frame;
  for (const TilePlane& tile_plane : planes.planes) {
    const Eigen::Vector3d n(tile_plane.plane.x, tile_plane.plane.y, tile_plane.plane.z);
    SweepPlane plane;
    plane.distance_m = 1 / n.norm();
    plane.normal = n * plane.distance_m;
    plane.reused = tile_plane.reused;
    plane.center_m.setZero();
    sweep.planes.push_back(plane);
  }
  const TileGrid& tiles = planes.tiles;
  for (int tile_row = 0; tile_row < tiles.down; ++tile_row) {
    for (int tile = 0; tile < tiles.across; ++tile) {
      const std::int32_t index = planes.plane_of_tile[tiles.index(tile_row, tile)];
      if (index < 0) continue;
      const int first_row = TileGrid::first_row(tile_row), first_column = TileGrid::first_column(tile);
      PlaneTile piece;
      piece.plane = static_cast<std::uint32_t>(index);
      piece.row = static_cast<std::uint32_t>(first_row);
      piece.column = static_cast<std::uint32_t>(first_column);
      piece.cells = static_cast<std::uint32_t>((tiles.end_row(tile_row) - first_row) *
                                               (tiles.end_column(tile) - first_column));
      const Eigen::Vector3d center_m = center_of(frame_of_tile(rays, tiles, tile_row, tile, 0).at,
                                                 planes.planes[static_cast<std::size_t>(index)].plane);
      if (!(center_m.norm() < kFarthestM)) continue;  // beyond the plane's horizon, or of a damaged plane
      piece.center_m = center_m.cast<float>();
      SweepPlane& plane = sweep.planes[piece.plane];
      ++plane.tiles;
      plane.cells += piece.cells;
      plane.center_m += center_m;
      sweep.tiles.push_back(piece);
    }
  }
  for (SweepPlane& plane : sweep.planes) plane.center_m /= std::max(1U, plane.tiles);
  measure_extents(sweep);
  return sweep;
}

}  // namespace pointreel
