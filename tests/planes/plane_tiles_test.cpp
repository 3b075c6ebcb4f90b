// Planes on tiles: their levels, the search for them, and their bytes.
#include "planes/plane_tiles.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "planes/plane_choice.h"
#include "planes/plane_search.h"
#include "planes/plane_tiles_coding.h"
#include "sensor_scene.h"

namespace pointreel {
namespace {

constexpr double kStepM = 0.05;

// Ranges of a scene of two walls and a floor, with noise, holes, and a part that is on no plane.
std::vector<float> noisy_ranges(const SensorScene& scene, float noise_m, std::uint32_t seed) {
  const SensorRays rays = scene.rays();
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(-noise_m, noise_m), wild(2, 40);
  const auto columns = static_cast<std::size_t>(rays.columns());
  std::vector<float> range_m(columns * static_cast<std::size_t>(rays.rows()), 60);
  for (const Plane& plane : {plane_of(1, 0.1, 0, 15), plane_of(-0.2, -1, 0, 7), plane_of(0, 0, -1, 1.7)}) {
    std::vector<float> met_m(columns);
    for (int row = 0; row < rays.rows(); ++row) {
      rays.plane_ranges_m(plane, row, 0, met_m);
      for (std::size_t c = 0; c < columns; ++c) {
        float& range = range_m[static_cast<std::size_t>(row) * columns + c];
        if (met_m[c] > 0.5F && met_m[c] < range) range = met_m[c];
      }
    }
  }
  for (std::size_t i = 0; i < range_m.size(); ++i) {
    range_m[i] += noise(random);
    if (i % columns > columns - 40) range_m[i] = wild(random);
    if (random() % 9 == 0) range_m[i] = 0;
  }
  return range_m;
}

PlaneTiles search(const SensorScene& scene, const std::vector<float>& range_m, float tolerance_m,
                  const MovedPlanes& earlier = {}) {
  const SensorRays rays = scene.rays();
  const std::vector<float> tolerances_m(range_m.size(), tolerance_m);
  return find_planes({rays, range_m, tolerances_m, kStepM, earlier});
}

void expect_same(const PlaneTiles& a, const PlaneTiles& b) {
  EXPECT_EQ(a.plane_of_tile, b.plane_of_tile);
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (std::size_t i = 0; i < a.planes.size(); ++i) {
    EXPECT_EQ(a.planes[i].levels, b.planes[i].levels);
    EXPECT_EQ(a.planes[i].reused, b.planes[i].reused);
    EXPECT_EQ(a.planes[i].plane.x, b.planes[i].plane.x);
    EXPECT_EQ(a.planes[i].plane.y, b.planes[i].plane.y);
    EXPECT_EQ(a.planes[i].plane.z, b.planes[i].plane.z);
  }
}

RC_GTEST_PROP(PlaneLevels, AreTheNearestToWhatTheyDescribe, ()) {
  const auto unit = [] { return *rc::gen::inRange(-1000, 1001) / 1000.0; };
  const PlaneFrame frame{{0.6, -0.8, 0.3 * unit(), 0.2}, 0.01 + 0.1 * std::fabs(unit()), 0.05};
  const PlaneLevels levels{*rc::gen::inRange(20, 2000), *rc::gen::inRange(-300, 300),
                           *rc::gen::inRange(-300, 300)};
  const Plane plane = plane_from_levels(frame, levels, kStepM);
  const auto again = levels_of_plane(frame, plane, kStepM);
  RC_ASSERT(again.has_value());
  RC_ASSERT(*again == levels);
}

TEST(PlaneLevels, ADistanceKeepsTheNormal) {
  const PlaneFrame frame{{0.8, 0.6, -0.1, 0.2}, 0.02, 0.05};
  const Plane plane = plane_of(1, 0.4, -0.2, 12);
  const auto level = distance_level(frame, plane, kStepM);
  ASSERT_TRUE(level);
  const Plane moved = plane_at_distance(frame, plane, *level + 7, kStepM);
  EXPECT_EQ(distance_level(frame, moved, kStepM), *level + 7);
  EXPECT_NEAR(moved.x * plane.y, moved.y * plane.x, 1e-12);
  EXPECT_NEAR(moved.x * plane.z, moved.z * plane.x, 1e-12);
  EXPECT_FALSE(distance_level(frame, plane_of(-1, 0, 0, 12), kStepM)) << "behind";
}

TEST(FindPlanes, EveryReturnOnATileMeetsItsPlane) {
  constexpr float kToleranceM = 0.1F;
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  for (const float noise_m : {0.0F, 0.02F, 0.08F}) {
    const auto range_m = noisy_ranges(scene, noise_m, 1);
    const PlaneTiles planes = search(scene, range_m, kToleranceM);
    const auto on_planes_m = ranges_on_planes_m(rays, planes, 1);
    std::size_t on_planes = 0, returns = 0;
    for (std::size_t i = 0; i < range_m.size(); ++i) {
      if (!(range_m[i] > 0)) continue;
      ++returns;
      if (!(on_planes_m[i] > 0)) continue;
      ++on_planes;
      EXPECT_LE(std::fabs(on_planes_m[i] - range_m[i]), kToleranceM);
    }
    EXPECT_GT(static_cast<double>(on_planes), (noise_m < 0.05F ? 0.6 : 0.3) * static_cast<double>(returns))
        << noise_m;
  }
}

TEST(FindPlanes, OnePlaneIsFoundOnce) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  std::vector<float> range_m;
  for (int row = 0; row < rays.rows(); ++row) {
    std::vector<float> of_row(static_cast<std::size_t>(rays.columns()));
    rays.plane_ranges_m(plane_of(1, 0, 0, 10), row, 0, of_row);
    for (const float range : of_row) range_m.push_back(range > 1 && range < 12 ? range : 0);
  }
  const PlaneTiles planes = search(scene, range_m, 0.1F);
  // The seam of the image cuts the wall, and rounding its far ends may.
  EXPECT_LE(planes.planes.size(), 4u);
  EXPECT_GE(planes.planes.size(), 1u);
}

TEST(FindPlanes, PlanesOfTheSweepBeforeAreUsedAgain) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  const PlaneTiles before = search(scene, noisy_ranges(scene, 0.01F, 2), 0.1F);
  const MovedPlanes earlier(rays, before, Pose::Identity(), rays, before.tiles);
  const PlaneTiles now = search(scene, noisy_ranges(scene, 0.01F, 3), 0.1F, earlier);
  std::size_t reused = 0;
  for (const TilePlane& plane : now.planes) reused += plane.reused ? 1 : 0;
  EXPECT_GT(2 * reused, now.planes.size());
  const auto bytes = encode_plane_tiles(rays, kStepM, earlier, now);
  EXPECT_LT(bytes.size(),
            encode_plane_tiles(rays, kStepM, {}, search(scene, noisy_ranges(scene, 0.01F, 3), 0.1F)).size());
  const auto decoded = decode_plane_tiles(rays, kStepM, earlier, bytes);
  ASSERT_TRUE(decoded);
  expect_same(*decoded, now);
}

TEST(MovedPlanes, HoldTheSamePointsInTheOtherSweep) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  PlaneTiles before;
  before.tiles = TileGrid(rays.rows(), rays.columns());
  before.plane_of_tile.assign(before.tiles.count(), -1);
  before.planes.push_back({false, 0, {}, plane_of(1, 0.2, 0.1, 14)});
  Pose T_ref_cur = Pose::Identity();
  T_ref_cur.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.1, 0.2, 1).normalized()).toRotationMatrix();
  T_ref_cur.translation() << 1.2, -0.3, 0.1;
  const MovedPlanes moved(rays, before, T_ref_cur, rays, before.tiles);
  const Plane& n = moved.planes[0];
  for (const Eigen::Vector3d& on_reference : {Eigen::Vector3d(14, 3, -2), Eigen::Vector3d(13, -5, 6)}) {
    const Plane& r = before.planes[0].plane;
    const Eigen::Vector3d p_ref =
        on_reference / (r.x * on_reference.x() + r.y * on_reference.y() + r.z * on_reference.z());
    const Eigen::Vector3d p = T_ref_cur.inverse() * p_ref;
    EXPECT_NEAR(n.x * p.x() + n.y * p.y() + n.z * p.z(), 1, 1e-12);
  }
}

TEST(DropDearPlanes, KeepsThoseThatPay) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  const auto range_m = noisy_ranges(scene, 0.02F, 4);
  const PlaneTiles all = search(scene, range_m, 0.1F);
  PlaneTiles kept = all;
  drop_dear_planes(range_m, 0.2, kept);
  EXPECT_LT(kept.planes.size(), all.planes.size());
  EXPECT_GT(kept.planes.size(), 0u);
  std::vector<int> tiles(kept.planes.size());
  for (const std::int32_t plane : kept.plane_of_tile) {
    if (plane >= 0) ++tiles[static_cast<std::size_t>(plane)];
  }
  for (const int count : tiles) EXPECT_GT(count, 1) << "a plane for 16 points takes more than they do";
  // Finer steps make points dearer.
  PlaneTiles finer = all;
  drop_dear_planes(range_m, 0.02, finer);
  EXPECT_GT(finer.planes.size(), kept.planes.size());
}

RC_GTEST_PROP(PlaneTilesCoding, GivesBackWhatWentIn, ()) {
  const SensorScene scene(*rc::gen::inRange(1, 20), *rc::gen::inRange(1, 320));
  const auto range_m = noisy_ranges(scene, 0.02F, *rc::gen::arbitrary<std::uint32_t>());
  const PlaneTiles planes = search(scene, range_m, *rc::gen::element(0.02F, 0.1F, 1.0F));
  const auto bytes = encode_plane_tiles(scene.rays(), kStepM, {}, planes);
  const auto decoded = decode_plane_tiles(scene.rays(), kStepM, {}, bytes);
  RC_ASSERT(static_cast<bool>(decoded));
  expect_same(*decoded, planes);
}

RC_GTEST_PROP(PlaneTilesCoding, AnyBytesGivePlanesOrAnError, ()) {
  const SensorScene scene;
  const auto bytes = *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::arbitrary<std::uint8_t>());
  const auto decoded = decode_plane_tiles(scene.rays(), kStepM, {}, bytes);
  if (!decoded) return;
  for (const std::int32_t plane : decoded->plane_of_tile)
    RC_ASSERT(plane >= -1 && plane < static_cast<std::int32_t>(decoded->planes.size()));
  for (const float range : ranges_on_planes_m(scene.rays(), *decoded, 1))
    RC_ASSERT(range == 0 || (range >= 1e-3F && range <= 2e5F));
}

}  // namespace
}  // namespace pointreel
