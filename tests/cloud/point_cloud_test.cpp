#include "pointreel/point_cloud.h"

#include <gtest/gtest.h>

#include <limits>

namespace pointreel {
namespace {

TEST(PointCloud, CountsNonFinitePoints) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const PointCloud cloud{{{1, 2, 3}, {nan, 0, 0}, {0, inf, 0}, {0, 0, -inf}}, {}};
  EXPECT_EQ(cloud.size(), 4u);
  EXPECT_EQ(cloud.count_non_finite(), 3u);
}

TEST(PointCloud, FindsFieldsByName) {
  const PointCloud cloud{{{1, 2, 3}}, {{"ring", std::vector<std::uint16_t>{7}}}};
  ASSERT_NE(cloud.find_field("ring"), nullptr);
  EXPECT_EQ(cloud.find_field("ring")->size(), 1u);
  EXPECT_EQ(cloud.find_field("intensity"), nullptr);
}

}  // namespace
}  // namespace pointreel
