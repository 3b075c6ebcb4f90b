#include "sim/ray_cast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pointreel::sim {
namespace {

using Eigen::Vector3d;

SceneObject make_object(Shape shape, double yaw_rad = 0) {
  return {shape, Material::brick, 3, {10, 0}, {2, 1}, std::cos(yaw_rad), std::sin(yaw_rad), 0, 4};
}

Ray ray_towards(const Vector3d& target_m) {
  const Vector3d origin_m(0, 0, 1.5);
  return {origin_m, (target_m - origin_m).normalized()};
}

TEST(RayCast, BoxStopsTheBeamAtItsNearSide) {
  const auto hit = cast(ray_towards({10, 0, 1.5}), make_object(Shape::box), 0, 100);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 8, 1e-9);
  EXPECT_NEAR(hit->cos_incidence, 1, 1e-9);
  EXPECT_FALSE(cast(ray_towards({10, 0, 1.5}), make_object(Shape::box), 0, 7.9));
  EXPECT_FALSE(cast(ray_towards({10, 1.5, 1.5}), make_object(Shape::box), 0, 100));
  EXPECT_FALSE(cast(ray_towards({-10, 0, 1.5}), make_object(Shape::box), 0, 100));
  EXPECT_FALSE(cast(ray_towards({10, 0, 6.5}), make_object(Shape::box), 0, 100));
}

TEST(RayCast, BoxTurnsAndMoves) {
  SceneObject box = make_object(Shape::box, std::numbers::pi / 2);
  EXPECT_NEAR(cast(ray_towards({10, 0, 1.5}), box, 0, 100)->range_m, 9, 1e-9);
  box.velocity_mps = {10, 0};
  EXPECT_NEAR(cast(ray_towards({10, 0, 1.5}), box, 0.05, 100)->range_m, 9.5, 1e-9);
}

TEST(RayCast, CylinderIsRound) {
  const auto hit = cast(ray_towards({10, 0, 1.5}), make_object(Shape::cylinder), 0, 100);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 8, 1e-9);
  EXPECT_TRUE(cast(ray_towards({10, 1.9, 1.5}), make_object(Shape::cylinder), 0, 100));
  EXPECT_FALSE(cast(ray_towards({10, 2.1, 1.5}), make_object(Shape::cylinder), 0, 100));
}

// Shares of a fan of beams at a 4 m wide front, 8 m away.
struct FanCount {
  int beams = 0, hits = 0, recessed = 0;  // recessed: at least 9 cm behind the front
  double min_depth_m = 1e9, max_depth_m = 0;
};

FanCount cast_fan(const SceneObject& object) {
  FanCount count;
  for (double y = -0.9; y < 0.9; y += 0.01) {
    for (double z = 0.5; z < 3.5; z += 0.1) {
      ++count.beams;
      const Ray ray = ray_towards({8, y, z});
      const auto hit = cast(ray, object, 0, 100);
      if (!hit) continue;
      ++count.hits;
      const double depth_m = hit->range_m * ray.direction.x();
      if (depth_m > 8.09) ++count.recessed;
      count.min_depth_m = std::min(count.min_depth_m, depth_m);
      count.max_depth_m = std::max(count.max_depth_m, depth_m);
    }
  }
  return count;
}

TEST(RayCast, FacadeHasRecessedWindows) {
  SceneObject building = make_object(Shape::building, std::numbers::pi / 2);
  building.half_size_m = {10, 2};
  const FanCount count = cast_fan(building);
  EXPECT_EQ(count.hits, count.beams);
  EXPECT_GT(count.recessed, 0);
  EXPECT_LT(count.recessed, count.beams / 2);
  EXPECT_NEAR(count.min_depth_m, 8, 1e-9);
  EXPECT_GT(count.max_depth_m, 8.1);
  EXPECT_LT(count.max_depth_m, 8.36);
}

TEST(RayCast, SlatsLetSomeBeamsThrough) {
  const FanCount count = cast_fan([] {
    SceneObject fence = make_object(Shape::slats, std::numbers::pi / 2);
    fence.center_m.x() = 8;
    fence.half_size_m = {10, 0.02};
    return fence;
  }());
  EXPECT_GT(count.hits, 0.4 * count.beams);
  EXPECT_LT(count.hits, 0.8 * count.beams);
}

TEST(RayCast, FoliageIsPorousAndStaysTheSame) {
  const FanCount count = cast_fan(make_object(Shape::foliage));
  EXPECT_GT(count.hits, 0.5 * count.beams);
  EXPECT_LT(count.hits, count.beams);
  EXPECT_GT(count.max_depth_m - count.min_depth_m, 2);
  const FanCount again = cast_fan(make_object(Shape::foliage));
  EXPECT_EQ(again.hits, count.hits);
  EXPECT_EQ(again.max_depth_m, count.max_depth_m);
}

}  // namespace
}  // namespace pointreel::sim
