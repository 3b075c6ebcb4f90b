#include "planes/plane_fit.h"

#include <gtest/gtest.h>

#include <string>

#include "test_images.h"

namespace pointreel {
namespace {

double range_on(const Plane& plane, const Ray& ray) {
  return 1 / (plane.x * ray.x + plane.y * ray.y + plane.z * ray.z);
}

struct Patch {
  std::string what;
  Plane plane;
  int first_row, rows, first_column, columns;
};

// Fits a plane to the exact ranges of a patch of cells; the largest error of the fit over them.
double largest_error_m(const AngularGrid& grid, const Patch& patch) {
  PlaneMoments moments;
  const auto each_ray = [&](const auto& visit) {
    for (int row = patch.first_row; row < patch.first_row + patch.rows; ++row) {
      for (int column = patch.first_column; column < patch.first_column + patch.columns; ++column) {
        visit(centre_ray(grid, row, column));
      }
    }
  };
  each_ray([&](const Ray& ray) { moments.add(ray.x, ray.y, ray.z, range_on(patch.plane, ray)); });
  const Plane fitted = moments.fit();
  double largest_m = 0;
  each_ray([&](const Ray& ray) {
    largest_m = std::max(largest_m, std::fabs(range_on(fitted, ray) - range_on(patch.plane, ray)));
  });
  return largest_m;
}

TEST(PlaneFit, ReproducesPointsOnAPlane) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  // Row 200 is the horizon; 220 looks 9 deg down, where flat ground is 11 m away.
  for (const Patch& patch : {
           Patch{"wall ahead", {1 / 10.0, 0, 0}, 198, 4, 0, 4},
           Patch{"slanted wall", {0.03, 0.08, 0.01}, 190, 4, 300, 16},
           Patch{"ground, x coefficient 0", {0, 0, -1 / 1.73}, 220, 4, 700, 4},
           Patch{"far ground", {0, 0, -1 / 1.73}, 202, 4, 100, 40},
           Patch{"ceiling", {0, 0, 1 / 2.5}, 100, 4, 1500, 8},
           Patch{"one row", {1 / 10.0, 0.02, 0}, 198, 1, 0, 8},
           Patch{"one column", {1 / 10.0, 0.02, 0}, 190, 8, 20, 1},
           Patch{"one point", {1 / 30.0, 0, 0}, 198, 1, 0, 1},
           Patch{"two points", {1 / 30.0, 0, 0}, 198, 1, 0, 2},
           Patch{"near the sensor", {1 / 0.02, 0, 0}, 198, 4, 0, 4},
           Patch{"10 km away", {1e-4, 0, 0}, 198, 4, 0, 4},
       }) {
    const double range_m = range_on(patch.plane, centre_ray(grid, patch.first_row, patch.first_column));
    ASSERT_GT(range_m, 0) << patch.what;
    EXPECT_LT(largest_error_m(grid, patch), 1e-5 * range_m) << patch.what;
  }
}

TEST(PlaneFit, MomentsOfTilesAddUp) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  PlaneMoments left, right, both;
  for (int column = 0; column < 8; ++column) {
    for (int row = 210; row < 214; ++row) {
      const Ray ray = centre_ray(grid, row, column);
      const double range_m = 9 + 0.01 * ((column * 7 + row * 3) % 5);
      (column < 4 ? left : right).add(ray.x, ray.y, ray.z, range_m);
      both.add(ray.x, ray.y, ray.z, range_m);
    }
  }
  left += right;
  const Plane sum = left.fit(), whole = both.fit();
  EXPECT_NEAR(sum.x, whole.x, 1e-9);
  EXPECT_NEAR(sum.y, whole.y, 1e-9);
  EXPECT_NEAR(sum.z, whole.z, 1e-9);
}

TEST(PlaneFit, MinimisesRangeErrors) {
  // A fit to noisy ranges is no worse than the true plane, in the sum of squared range errors.
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  const Plane truth{1 / 10.0, 0.01, 0};
  std::mt19937 random(1);
  std::normal_distribution<double> noise_m(0, 0.02);
  PlaneMoments moments;
  std::vector<std::pair<Ray, double>> samples;
  for (int row = 196; row < 204; ++row) {
    for (int column = 0; column < 40; ++column) {
      const Ray ray = centre_ray(grid, row, column);
      samples.emplace_back(ray, range_on(truth, ray) + noise_m(random));
      moments.add(ray.x, ray.y, ray.z, samples.back().second);
    }
  }
  const auto squares_m2 = [&](const Plane& plane) {
    double sum = 0;
    for (const auto& [ray, range_m] : samples) sum += std::pow(range_on(plane, ray) - range_m, 2);
    return sum;
  };
  EXPECT_LT(squares_m2(moments.fit()), squares_m2(truth));
}

TEST(PlaneFit, OfNothingIsThePlaneAtInfinity) {
  const Plane plane = PlaneMoments().fit();
  EXPECT_EQ(plane.x, 0);
  EXPECT_EQ(plane.y, 0);
  EXPECT_EQ(plane.z, 0);
}

}  // namespace
}  // namespace pointreel
