#include "planes/sensor_rays.h"

#include <gtest/gtest.h>

#include "sensor_scene.h"

namespace pointreel {
namespace {

TEST(SensorRays, MeetPlanesWhereTheDecoderPutsThePoints) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  for (const Plane& plane :
       {plane_of(1, 0.2, 0.1, 20), plane_of(-0.3, 1, 0, 6), plane_of(0, 0.01, -1, 1.7)}) {
    int met = 0;
    for (int row = 0; row < rays.rows(); ++row) {
      std::vector<float> range_m(static_cast<std::size_t>(rays.columns()));
      rays.plane_ranges_m(plane, row, 0, range_m);
      for (int column = 0; column < rays.columns(); ++column) {
        const float range = range_m[static_cast<std::size_t>(column)];
        if (!(range > 1.5F && range < 100)) continue;  // the plane is behind the ray, or at its horizon
        ++met;
        // h^2 / 2 rho, and the rounding of the range at grazing angles.
        EXPECT_LT(off_plane(plane, scene.point(row, column, range)), 5e-4) << row << ", " << column;
      }
    }
    EXPECT_GT(met, 300);
  }
}

TEST(SensorRays, PartsOfARowHaveTheSameRanges) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  const Plane plane = plane_of(1, 0.3, -0.2, 9);
  std::vector<float> all(static_cast<std::size_t>(rays.columns())), part(40);
  rays.plane_ranges_m(plane, 3, 0, all);
  rays.plane_ranges_m(plane, 3, 171, part);
  for (std::size_t c = 0; c < part.size(); ++c) EXPECT_EQ(part[c], all[171 + c]);
}

TEST(SensorRays, PlanesOutOfSightGiveRangesWithinLimits) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  std::vector<float> range_m(static_cast<std::size_t>(rays.columns()));
  const double nan = std::nan("");
  for (const Plane& plane :
       {Plane{0, 0, 0}, Plane{1e300, -1e300, 1}, Plane{nan, 1, 1}, Plane{1e-300, 0, 0}}) {
    rays.plane_ranges_m(plane, 0, 0, range_m);
    for (const float range : range_m) EXPECT_TRUE(range >= 1e-3F && range <= 2e5F) << range;
  }
}

TEST(SensorRays, FindTheCellOfAPoint) {
  const SensorScene scene;
  const SensorRays rays = scene.rays();
  for (int row = 0; row < rays.rows(); ++row) {
    for (int column = 0; column < rays.columns(); column += 7) {
      const Point3f p = scene.point(row, column, 12);
      const auto cell =
          rays.cell_towards(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z), 5);
      ASSERT_TRUE(cell);
      EXPECT_EQ(cell->row, row);
      const int off = std::abs(cell->column - column);
      EXPECT_LE(std::min(off, rays.columns() - off), 1) << row << ", " << column;
    }
  }
  EXPECT_FALSE(rays.cell_towards(0.01, 0, -1, 0));
  EXPECT_FALSE(rays.cell_towards(10, 0, 9, 0)) << "far above the highest row";
}

}  // namespace
}  // namespace pointreel
