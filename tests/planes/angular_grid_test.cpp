#include "planes/angular_grid.h"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>

#include "planes/projection.h"
#include "support/expect_error.h"
#include "test_images.h"

namespace pointreel {
namespace {

// Degrees. Some divide the circle, some leave a narrower last column.
class GridSteps : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(GridSteps, TheRayOfACellFallsIntoThatCell) {
  const AngularGrid grid = grid_of_degrees(std::get<0>(GetParam()), std::get<1>(GetParam()));
  // The centre of the last row or column of a grid that does not divide the sphere may lie past its end.
  const int rows = grid.rows() - 1, columns = grid.columns() - 1;
  const int row_stride = 1 + rows / 300, column_stride = 1 + columns / 700;
  for (int row = 0; row < rows; row += row_stride) {
    for (int column = 0; column < columns; column += column_stride) {
      const Ray ray = centre_ray(grid, row, column);
      for (const double range_m : {0.01, 1.0, 1e4}) {
        const GridCell cell =
            grid.cell_of(static_cast<float>(range_m * ray.x), static_cast<float>(range_m * ray.y),
                         static_cast<float>(range_m * ray.z));
        ASSERT_EQ(cell.row, row) << "column " << column;
        ASSERT_EQ(cell.column, column) << "row " << row;
      }
    }
  }
}

TEST_P(GridSteps, CoverTheWholeSphereAndNoMore) {
  const AngularGrid grid = grid_of_degrees(std::get<0>(GetParam()), std::get<1>(GetParam()));
  EXPECT_GE(grid.rows() * grid.elevation_step_rad(), kPi * (1 - 1e-9));
  EXPECT_LT((grid.rows() - 1) * grid.elevation_step_rad(), kPi);
  EXPECT_GE(grid.columns() * grid.azimuth_step_rad(), kTurn * (1 - 1e-9));
  EXPECT_LT((grid.columns() - 1) * grid.azimuth_step_rad(), kTurn);
}

INSTANTIATE_TEST_SUITE_P(Degrees, GridSteps,
                         testing::Values(std::tuple{0.18, 0.45}, std::tuple{0.09, 0.2}, std::tuple{1.0, 1.0},
                                         std::tuple{0.7, 0.33}, std::tuple{5.0, 3.7},
                                         std::tuple{0.02, 0.02}));

TEST(AngularGrid, KeepsPolesAndBordersInside) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  EXPECT_EQ(grid.cell_of(0, 0, 1).row, 0);
  EXPECT_EQ(grid.cell_of(0, 0, -1).row, grid.rows() - 1);
  EXPECT_EQ(grid.cell_of(1, 0, 0).column, 0);
  EXPECT_EQ(grid.cell_of(1, -1e-30F, 0).column, grid.columns() - 1) << "just right of straight ahead";
  EXPECT_EQ(grid.cell_of(1, -0.0F, 0).column, 0);
  EXPECT_EQ(grid.cell_of(-1, 1e-6F, 0).column, grid.columns() / 2 - 1);
}

TEST(AngularGrid, RejectsStepsOutsideItsLimits) {
  const double good = 0.01;
  for (const double bad : {0.0, -0.01, 0.000299, 0.1001, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    expect_error(AngularGrid::create(bad, good), ErrorCode::invalid_argument, "steps must lie between");
    expect_error(AngularGrid::create(good, bad), ErrorCode::invalid_argument, "steps must lie between");
  }
  for (const double limit : {AngularGrid::kMinStep_rad, AngularGrid::kMaxStep_rad}) {
    EXPECT_TRUE(AngularGrid::create(limit, limit));
  }
}

TEST(Projection, NearestPointOfACellStaysAndComesBackAtItsCentre) {
  const AngularGrid grid = grid_of_degrees(1, 1);
  const Ray ray = centre_ray(grid, 100, 30);
  const auto at = [&](double range_m) {
    return Point3f{static_cast<float>(range_m * ray.x), static_cast<float>(range_m * ray.y),
                   static_cast<float>(range_m * ray.z)};
  };
  const PointCloud cloud{{at(7), at(5), at(9), at(5.5)}, {}};
  const auto image = range_image_of(grid, project_points(grid, cloud, Pose::Identity()), 4);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->first_row % 4, 0);
  EXPECT_EQ(image->rows, 4);
  EXPECT_EQ(count_occupied(*image), 1u);
  const PointCloud back = cloud_of(grid, *image, Pose::Identity());
  ASSERT_EQ(back.size(), 1u);
  EXPECT_NEAR(back.positions[0].x, 5 * ray.x, 1e-5);
  EXPECT_NEAR(back.positions[0].y, 5 * ray.y, 1e-5);
  EXPECT_NEAR(back.positions[0].z, 5 * ray.z, 1e-5);
}

TEST(Projection, PointsWithoutADirectionOrTooFarHaveNoPlace) {
  const AngularGrid grid = grid_of_degrees(1, 1);
  const float infinity = std::numeric_limits<float>::infinity();
  const PointCloud cloud{{{0, 0, 0}, {infinity, 0, 0}, {std::nanf(""), 1, 1}, {1e5f, 1e3f, 0}, {1e30f, 0, 0}},
                         {}};
  const auto image = range_image_of(grid, project_points(grid, cloud, Pose::Identity()), 4);
  ASSERT_TRUE(image);
  EXPECT_EQ(count_occupied(*image), 0u);
  EXPECT_EQ(image->rows, 0);
}

TEST(Projection, TooManyCellsAreAnErrorAndNoAllocation) {
  auto grid = AngularGrid::create(AngularGrid::kMinStep_rad, AngularGrid::kMinStep_rad);
  ASSERT_TRUE(grid);
  const PointCloud poles{{{0, 0, 1}, {0, 0, -1}}, {}};
  expect_error(range_image_of(*grid, project_points(*grid, poles, Pose::Identity()), 4),
               ErrorCode::resource_limit, "--azimuth-step");
}

}  // namespace
}  // namespace pointreel
