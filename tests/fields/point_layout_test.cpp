#include "fields/point_layout.h"

#include <gtest/gtest.h>

namespace pointreel {
namespace {

std::vector<std::uint32_t> points_of(const PointLayout& layout) {
  std::vector<std::uint32_t> points;
  for (const auto& place : layout.raster()) points.push_back(place.point);
  return points;
}

TEST(PointLayout, OrdersByCellAndPutsPointsOffTheGridLast) {
  const std::vector<std::int32_t> cells = {5, -1, 0, 2, 0, 6, 4};  // 6 is outside a grid of 2 x 3
  const std::vector<float> ranges(cells.size(), 1);
  const PointLayout layout({2, 3, cells, ranges});
  EXPECT_EQ(points_of(layout), (std::vector<std::uint32_t>{2, 4, 3, 6, 0, 1, 5}));
  EXPECT_EQ(layout.rows(), 3u);
  EXPECT_EQ(layout.raster()[4].row, 1u);
  EXPECT_EQ(layout.raster()[4].column, 2u);
  EXPECT_EQ(layout.raster()[5].row, 2u);
  EXPECT_EQ(layout.raster()[5].column, 0u);
}

TEST(PointLayout, KeepsTheOrderWithoutAGrid) {
  const std::vector<std::int32_t> cells(4, -1);
  const std::vector<float> ranges(4, 1);
  EXPECT_EQ(points_of(PointLayout({0, 0, cells, ranges})), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(PointLayout({}).size(), 0u);
}

}  // namespace
}  // namespace pointreel
