#include "planes/run_anchors.h"

#include <gtest/gtest.h>

#include "test_images.h"

namespace pointreel {
namespace {

constexpr double kStep_m = 0.05;

struct AnchoredImage {
  AngularGrid grid = grid_of_degrees(0.18, 0.45);
  RangeImage image = empty_image(grid, 196, 4);
  TileLayout layout{image, 4};
  PlaneRun run;

  explicit AnchoredImage(const std::vector<GridCell>& occupied) {
    run.first_tile = 0;
    run.end_tile = 5;
    for (const GridCell& cell : occupied) image.at(cell.row, cell.column) = 10.0f;
  }
  RunAnchors anchors() const { return choose_anchors(image, layout, run); }
};

std::vector<GridCell> all_of_five_tiles() {
  std::vector<GridCell> cells;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 20; ++column) cells.push_back({row, column});
  }
  return cells;
}

TEST(RunAnchors, LieAtTheCornersOfAFullRun) {
  const RunAnchors anchors = AnchoredImage(all_of_five_tiles()).anchors();
  ASSERT_EQ(anchors.count, 3);
  EXPECT_EQ(anchors.cells[0].column, 0);
  EXPECT_EQ(anchors.cells[1].column, 19);
  EXPECT_EQ(anchors.cells[0].row, 199) << "in rows of the grid, the lowest of its column";
  EXPECT_EQ(anchors.cells[2].row, 196) << "as far as can be from the line between the others";
}

TEST(RunAnchors, AreFewerWhereCellsLieOnALine) {
  EXPECT_EQ(AnchoredImage({}).anchors().count, 0);
  EXPECT_EQ(AnchoredImage({{2, 7}}).anchors().count, 1);
  EXPECT_EQ(AnchoredImage({{2, 7}, {2, 9}, {2, 13}}).anchors().count, 2);
  EXPECT_EQ(AnchoredImage({{0, 7}, {2, 7}, {3, 7}}).anchors().count, 2);
  EXPECT_EQ(AnchoredImage({{0, 0}, {1, 1}, {2, 2}}).anchors().count, 2);
  EXPECT_EQ(AnchoredImage({{0, 0}, {1, 1}, {2, 3}}).anchors().count, 3);
}

TEST(RunAnchors, ThePlaneMeetsTheAnchorsAtTheirRanges) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<GridCell> cells = all_of_five_tiles();
    std::shuffle(cells.begin(), cells.end(), random);
    cells.resize(1 + random() % 6);
    const AnchoredImage source(cells);
    const RunAnchors anchors = source.anchors();
    std::array<std::int32_t, 3> levels{};
    // From 0.05 m to 100 m; within a factor of two, as on one surface.
    const auto base = static_cast<std::int32_t>(1 + random() % 1000);
    for (auto& level : levels) level = base + static_cast<std::int32_t>(random() % (base + 1));
    const Plane plane = plane_from_anchors(source.grid, anchors, levels, kStep_m);
    for (int i = 0; i < anchors.count; ++i) {
      const GridCell cell = anchors.cells[i];
      const double range_m = levels[i] * kStep_m;
      // plane_range is float32, and neighbouring rays lose some more digits to each other.
      EXPECT_NEAR(plane_range(source.grid, plane, cell.row, cell.column), range_m, 1e-3 * range_m)
          << "anchor " << i << " of " << anchors.count << ", trial " << trial;
    }
  }
}

TEST(RunAnchors, NearestLevelStaysWithinItsLimits) {
  EXPECT_EQ(nearest_level(1.0, 0.25), 4);
  EXPECT_EQ(nearest_level(1.12, 0.25), 4);
  EXPECT_EQ(nearest_level(1.13, 0.25), 5);
  for (const double low : {0.0, -5.0, 1e-9, -HUGE_VAL, std::nan("")}) EXPECT_EQ(nearest_level(low, 0.05), 1);
  for (const double high : {1e30, HUGE_VAL}) EXPECT_EQ(nearest_level(high, 0.05), kMaxLevel);
}

}  // namespace
}  // namespace pointreel
