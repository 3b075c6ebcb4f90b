#include "codec/point_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace pointreel {
namespace {

TEST(PointMatching, FindsAPermutation) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-5, 5), shift(-0.01F, 0.01F);
  std::vector<Point3f> originals(2000), decoded;
  for (Point3f& p : originals) p = {place(random), place(random), place(random)};
  for (const Point3f& p : originals)
    decoded.push_back({p.x + shift(random), p.y + shift(random), p.z + shift(random)});
  std::shuffle(decoded.begin(), decoded.end(), random);
  const auto pairs = match_points(originals, decoded, 0.02);
  EXPECT_EQ(std::set<std::int64_t>(pairs.begin(), pairs.end()).size(), originals.size());
  EXPECT_EQ(std::count(pairs.begin(), pairs.end(), -1), 0);
}

// The nearest first would leave the last original alone: 0 takes 1, so 1 takes 2, so 2 finds none.
TEST(PointMatching, GivesWayWhereGreedWouldFail) {
  const std::vector<Point3f> originals = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<Point3f> decoded = {{-0.9F, 0, 0}, {0.4F, 0, 0}, {1.3F, 0, 0}};
  const auto pairs = match_points(originals, decoded, 1);
  EXPECT_EQ(pairs, (std::vector<std::int64_t>{0, 1, 2}));
}

TEST(PointMatching, LeavesOutWhatIsTooFarOrNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Point3f> originals = {{0, 0, 0}, {nan, 0, 0}, {9, 0, 0}};
  const std::vector<Point3f> decoded = {{0.5F, 0, 0}, {7, 0, 0}};
  EXPECT_EQ(match_points(originals, decoded, 1), (std::vector<std::int64_t>{0, -1, -1}));
}

}  // namespace
}  // namespace pointreel
