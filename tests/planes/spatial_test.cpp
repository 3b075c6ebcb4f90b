#include "planes/spatial.h"

#include <gtest/gtest.h>

#include "planes/tile_cells.h"
#include "test_images.h"

namespace pointreel {
namespace {

std::vector<std::int32_t> marks_of(const RangeImage& image, const TileLayout& layout, int tile_row) {
  std::vector<std::int32_t> marks;
  for (int tile = 0; tile < layout.tile_columns; ++tile) {
    marks.push_back(tile_occupied(image, layout, tile_row, tile) ? kUnfitTile : kEmptyTile);
  }
  return marks;
}

std::vector<PlaneRun> spatial_runs(const AngularGrid& grid, const RangeImage& image,
                                   const PlaneTolerance& tolerance) {
  const TileLayout layout(image, 4);
  std::vector<PlaneRun> runs;
  for (int tile_row = 0; tile_row < layout.tile_rows; ++tile_row) {
    encode_tile_row_spatially(grid, image, layout, tile_row, marks_of(image, layout, tile_row).data(),
                              tolerance, runs);
  }
  return runs;
}

// Every cell of every run within the threshold on the plane that the run stores; returns their number.
std::size_t check_runs(const AngularGrid& grid, const RangeImage& image, const std::vector<PlaneRun>& runs,
                       float threshold_m) {
  const TileLayout layout(image, 4);
  std::size_t cells = 0;
  for (const PlaneRun& run : runs) {
    EXPECT_LT(run.first_tile, run.end_tile);
    all_cells(image, layout, run.tile_row, run.first_tile, run.end_tile,
              [&](int row, int column, float range_m) {
                const float decoded_m = plane_range(grid, run.plane, image.first_row + row, column);
                EXPECT_GT(decoded_m, 0);
                EXPECT_LE(std::fabs(decoded_m - range_m), threshold_m);
                return ++cells > 0;
              });
  }
  return cells;
}

TEST(SpatialPass, CoversWallsAndGroundWithFewLongRuns) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  RangeImage image = image_of_planes(grid, 192, 64, street_canyon());
  add_noise(image, 0.008f, 1);
  const PlaneTolerance tolerance{0.1f, 0.05};
  const auto runs = spatial_runs(grid, image, tolerance);
  const std::size_t on_planes = check_runs(grid, image, runs, tolerance.threshold_m);
  EXPECT_GT(on_planes, 0.97 * static_cast<double>(count_occupied(image)));
  // 16 rows of tiles, 500 tiles each, with at most five surfaces in a row.
  EXPECT_LT(runs.size(), 16u * 40u);
}

TEST(SpatialPass, OneWallIsOneRunPerRowOfTiles) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  RangeImage wall = image_of_planes(grid, 196, 8, {{1 / 10.0, 0, 0}});
  // Only the part within 45 deg to the left of straight ahead.
  for (int row = 0; row < wall.rows; ++row) {
    for (int column = 252; column < wall.columns; ++column) wall.at(row, column) = 0;
  }
  const auto runs = spatial_runs(grid, wall, {0.02f, 0.01});
  ASSERT_EQ(runs.size(), 2u);
  for (const PlaneRun& run : runs) {
    EXPECT_EQ(run.first_tile, 0);
    EXPECT_EQ(run.end_tile, 63);
  }
  EXPECT_EQ(check_runs(grid, wall, runs, 0.02f), 8u * 252u);
}

TEST(SpatialPass, EmptyTilesDoNotEndARun) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  RangeImage wall = image_of_planes(grid, 196, 4, {{1 / 10.0, 0, 0}});
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < wall.columns; ++column) {
      if (column >= 80 || (column >= 32 && column < 44)) wall.at(row, column) = 0;
    }
  }
  const auto runs = spatial_runs(grid, wall, {0.05f, 0.025});
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].end_tile, 20);
}

TEST(SpatialPass, LeavesTilesThatAreMarkedAlone) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  const RangeImage wall = image_of_planes(grid, 196, 4, street_canyon());
  const TileLayout layout(wall, 4);
  auto marks = marks_of(wall, layout, 0);
  for (int tile = 10; tile < 20; ++tile) marks[tile] = 0;  // on a run already
  std::vector<PlaneRun> runs;
  encode_tile_row_spatially(grid, wall, layout, 0, marks.data(), {0.1f, 0.05}, runs);
  ASSERT_FALSE(runs.empty());
  for (const PlaneRun& run : runs) EXPECT_TRUE(run.end_tile <= 10 || run.first_tile >= 20);
}

TEST(SpatialPass, HoldsTheThresholdOnVegetationAndDust) {
  const AngularGrid grid = grid_of_degrees(1, 1);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> range_m(0.001f, 3.0f);
  RangeImage image = empty_image(grid, 80, 16);
  for (float& range : image.range_m) range = random() % 3 ? range_m(random) : 0.0f;
  for (const float threshold_m : {0.001f, 0.1f, 1.0f, 10.0f}) {
    check_runs(grid, image, spatial_runs(grid, image, {threshold_m, threshold_m * 0.5}), threshold_m);
  }
}

}  // namespace
}  // namespace pointreel
