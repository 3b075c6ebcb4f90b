#include "sim/street.h"

#include <gtest/gtest.h>

#include "sim/random.h"
#include "sim/sector_index.h"
#include "sim/traffic.h"

namespace pointreel::sim {
namespace {

constexpr double reach_m = 135;

std::size_t count_objects(const Street& street) {
  std::size_t count = 0;
  for (const StreetBlock& block : street.blocks()) count += block.objects.size();
  return count;
}

TEST(Street, KeepsOnlyWhatIsNearOverALongDrive) {
  const Road road(31);
  Street street(road, 32);
  for (double x_m = 0; x_m < 100'000; x_m += 20) {
    street.cover(x_m - reach_m, x_m + reach_m);
    ASSERT_LE(street.blocks().size(), 5u);
    ASSERT_LT(count_objects(street), 2500u);
    ASSERT_GT(count_objects(street), 200u);
  }
}

TEST(Street, BlocksDependOnSeedAndIndexOnly) {
  const Road road(31);
  const StreetBlock block = make_street_block(road, 32, 7), same = make_street_block(road, 32, 7);
  ASSERT_EQ(block.objects.size(), same.objects.size());
  for (std::size_t i = 0; i < block.objects.size(); ++i) {
    EXPECT_EQ(block.objects[i].center_m, same.objects[i].center_m);
  }
  EXPECT_NE(block.objects.front().center_m, make_street_block(road, 33, 7).objects.front().center_m);
}

TEST(Street, LanesAreClear) {
  const Road road(31);
  for (std::int64_t index = -3; index < 200; ++index) {
    for (const SceneObject& o : make_street_block(road, 32, index).objects) {
      const double lateral_m =
          (o.center_m.y() - road.y_m(o.center_m.x())) * std::cos(road.heading_rad(o.center_m.x()));
      const double half_width_m = std::min(o.half_size_m.x(), o.half_size_m.y());
      if (o.z_min_m > 2.5) continue;
      EXPECT_GT(std::abs(lateral_m) - half_width_m, lane_centre_m + 1.2);
    }
  }
}

TEST(Traffic, CarsKeepGoingFromSweepToSweep) {
  const Road road(31);
  const VehicleMotion motion(road, 8, 5);
  const Traffic traffic(road, motion, 8, 6);
  std::vector<SceneObject> now, next;
  traffic.append_cars(20, 20.1, reach_m, now);
  traffic.append_cars(20.1, 20.2, reach_m, next);
  ASSERT_GT(now.size(), 8u);
  // The car ahead is first in both; every part of it must be where its velocity took it.
  const Eigen::Vector2d carried_m = now[0].center_m + 0.1 * now[0].velocity_mps;
  EXPECT_LT((carried_m - next[0].center_m).norm(), 0.02);
  EXPECT_GT(now[0].velocity_mps.x(), 4);
  EXPECT_LT(now.back().velocity_mps.x(), -4);
}

TEST(SectorIndex, FindsWhatASearchThroughAllObjectsFinds) {
  const Road road(31);
  const VehicleMotion motion(road, 8, 5);
  const Traffic traffic(road, motion, 8, 6);
  Street street(road, 32);
  Random random(1);
  for (const double begin_s : {0.0, 14.0, 33.0, 71.0}) {
    constexpr double sweep_s = 0.1;
    const double x_m = motion.road_position_m(begin_s);
    street.cover(x_m - reach_m, x_m + reach_m);
    std::vector<SceneObject> objects;
    for (const StreetBlock& b : street.blocks())
      objects.insert(objects.end(), b.objects.begin(), b.objects.end());
    traffic.append_cars(begin_s, begin_s + sweep_s, reach_m, objects);
    SectorIndex index;
    index.build(objects, motion.state(begin_s).T_world_sensor, motion.state(begin_s + sweep_s).T_world_sensor,
                sweep_s, 120);
    for (int i = 0; i < 2000; ++i) {
      const double age_s = random.uniform(0, sweep_s);
      const double azimuth_rad = random.uniform(-4, 4), elevation_rad = random.uniform(-0.44, 0.04);
      const Pose T_world_sensor = motion.state(begin_s + age_s).T_world_sensor;
      const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                      std::cos(elevation_rad) * std::sin(azimuth_rad),
                                      std::sin(elevation_rad));
      const Ray ray{T_world_sensor * Eigen::Vector3d(0.02, 0.02, 0.2), T_world_sensor.linear() * direction};
      const double yaw_rad = std::atan2(T_world_sensor(1, 0), T_world_sensor(0, 0));

      double nearest_m = 120, nearest_indexed_m = 120;
      for (const SceneObject& o : objects) {
        if (const auto hit = cast(ray, o, age_s, nearest_m)) nearest_m = hit->range_m;
      }
      const double horizontal = ray.direction.head<2>().norm(), slope = ray.direction.z() / horizontal;
      for (const auto& c : index.candidates(azimuth_rad + yaw_rad)) {
        if (c.min_distance_m > nearest_indexed_m * horizontal) break;
        if (slope < c.min_slope || slope > c.max_slope) continue;
        if (const auto hit = cast(ray, objects[c.object], age_s, nearest_indexed_m)) {
          nearest_indexed_m = hit->range_m;
        }
      }
      ASSERT_EQ(nearest_indexed_m, nearest_m);
    }
  }
}

}  // namespace
}  // namespace pointreel::sim
