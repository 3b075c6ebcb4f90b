#include "planes/planes_by_direction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace pointreel {
namespace {

// Tiles all around at 8 to 12 m, each on a plane of its own that faces any way.
SweepPlanes tiles_all_around(std::mt19937& random) {
  std::uniform_real_distribution<float> share(-1, 1);
  SweepPlanes sweep;
  for (std::uint32_t row = 0; row < 40; ++row) {
    for (std::uint32_t column = 0; column < 250; ++column) {
      const auto azimuth_rad = static_cast<float>(2 * std::numbers::pi * column / 250);
      const float rho_m = 10 + 2 * share(random), slope = 0.2F - 0.02F * static_cast<float>(row);
      PlaneTile tile;
      tile.plane = static_cast<std::uint32_t>(sweep.planes.size());
      tile.center_m = {rho_m * std::cos(azimuth_rad), rho_m * std::sin(azimuth_rad), rho_m * slope};
      SweepPlane plane;
      plane.normal = Eigen::Vector3f(share(random), share(random), share(random)).cast<double>().normalized();
      plane.distance_m = plane.normal.dot(tile.center_m.cast<double>());
      sweep.planes.push_back(plane);
      sweep.tiles.push_back(tile);
    }
  }
  return sweep;
}

// That of the nearest of all tiles that face the same way.
std::optional<double> distance_m(const SweepPlanes& sweep, const Eigen::Vector3f& p_m,
                                 const Eigen::Vector3f& normal) {
  std::optional<double> distance_m;
  float nearest_m = 0.5F + 0.1F * p_m.norm();
  for (const PlaneTile& tile : sweep.tiles) {
    const SweepPlane& plane = sweep.planes[tile.plane];
    const float away_m = (tile.center_m - p_m).norm();
    if (!(away_m < nearest_m) || !(plane.normal.cast<float>().dot(normal) > 0.97F)) continue;
    nearest_m = away_m;
    distance_m =
        (plane.normal.dot(p_m.cast<double>()) - plane.distance_m) * plane.normal.dot(normal.cast<double>());
  }
  return distance_m;
}

TEST(PlanesByDirection, MeasureToTheNearestTileThatFacesTheSameWay) {
  std::mt19937 random(7);
  const SweepPlanes sweep = tiles_all_around(random);
  const PlanesByDirection planes(sweep);
  std::uniform_real_distribution<float> off_m(-0.05F, 0.05F);
  PatchBlock block;
  block.count = 50;
  for (std::size_t first = 0; first + block.count <= sweep.tiles.size(); first += block.count) {
    for (std::size_t i = 0; i < block.count; ++i) {
      const PlaneTile& tile = sweep.tiles[first + i];
      block.set(i, tile.center_m + Eigen::Vector3f(off_m(random), off_m(random), off_m(random)),
                sweep.planes[tile.plane].normal.cast<float>());
    }
    for (std::size_t i = block.count; i % PatchBlock::kLanes != 0; ++i)
      block.set(i, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero());
    planes.measure(block);
    for (std::size_t i = 0; i < block.count; ++i) {
      const auto expected = distance_m(sweep, block.center_m(i), block.normal(i));
      ASSERT_TRUE(expected);
      ASSERT_NEAR(block.distance_m[i], *expected, 1e-4) << "tile " << first + i;
    }
  }
}

TEST(PlanesByDirection, FindNothingWhereNoTileFacesTheSameWayOrIsNear) {
  std::mt19937 random(8);
  SweepPlanes sweep = tiles_all_around(random);
  for (SweepPlane& plane : sweep.planes) plane.normal = Eigen::Vector3d::UnitX();
  const PlanesByDirection planes(sweep), none(SweepPlanes{});
  PatchBlock block;
  block.count = PatchBlock::kLanes;
  for (std::size_t i = 0; i < block.count; ++i) block.set(i, {10, 0, 0}, Eigen::Vector3f::UnitX());
  block.set(1, {10, 0, 0}, Eigen::Vector3f::UnitY());  // faces another way
  block.set(2, {20, 0, 0}, Eigen::Vector3f::UnitX());  // 8 m behind the tiles
  block.set(3, {0, 0, 1e6F}, Eigen::Vector3f::UnitX());
  planes.measure(block);
  EXPECT_LT(block.distance_m[0], PatchBlock::kNoPartner);
  for (const std::size_t alone : {1U, 2U, 3U}) EXPECT_EQ(block.distance_m[alone], PatchBlock::kNoPartner);
  none.measure(block);
  for (std::size_t i = 0; i < block.count; ++i) EXPECT_EQ(block.distance_m[i], PatchBlock::kNoPartner);
}

}  // namespace
}  // namespace pointreel
