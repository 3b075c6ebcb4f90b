// The bench's metrics on clouds whose differences are known.
#include "cloud_difference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "codec_measurement.h"

namespace pointreel {
namespace {

// A level square of points a metre apart.
PointCloud flat_square() {
  PointCloud cloud;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) cloud.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
  }
  return cloud;
}

std::vector<Point3f> moved(const PointCloud& cloud, const Point3f& by) {
  std::vector<Point3f> positions = cloud.positions;
  for (Point3f& p : positions) p = {p.x + by.x, p.y + by.y, p.z + by.z};
  return positions;
}

TEST(CloudDifference, IdenticalCloudsDifferNowhere) {
  const PointCloud cloud = flat_square();
  const CloudDifference difference = nearest_differences(ComparedSweep(cloud), cloud.positions);
  EXPECT_EQ(difference.to_decoded.each_m.size(), 400U);
  EXPECT_EQ(difference.largest_nearest_m(), 0);
  EXPECT_TRUE(std::isinf(difference.d1_psnr_db(30)));
}

TEST(CloudDifference, MovingUpCountsInFullAndAlongTheNormal) {
  const PointCloud cloud = flat_square();
  const CloudDifference difference = nearest_differences(ComparedSweep(cloud), moved(cloud, {0, 0, 0.1F}));
  EXPECT_NEAR(difference.to_decoded.mean_m(), 0.1, 1e-6);
  EXPECT_NEAR(difference.to_original.rms_m(), 0.1, 1e-6);
  EXPECT_NEAR(difference.to_original_plane.max_m(), 0.1, 1e-6);
  // 10 log10(3 * 30^2 / 0.1^2)
  EXPECT_NEAR(difference.d1_psnr_db(30), 54.3136, 1e-3);
  EXPECT_NEAR(difference.d2_psnr_db(30), 54.3136, 1e-3);
  EXPECT_NEAR(difference.d1_psnr_db(60) - difference.d1_psnr_db(30), 6.0206, 1e-3);
}

TEST(CloudDifference, MovingAsideIsNoDistanceFromThePlane) {
  const PointCloud cloud = flat_square();
  const CloudDifference difference = nearest_differences(ComparedSweep(cloud), moved(cloud, {0.1F, 0, 0}));
  EXPECT_NEAR(difference.to_decoded.max_m(), 0.1, 1e-5);
  EXPECT_NEAR(difference.to_decoded_plane.max_m(), 0, 1e-5);
  EXPECT_GT(difference.d2_psnr_db(30), difference.d1_psnr_db(30) + 20);
}

TEST(CloudDifference, APointThatIsGoneIsSeenFromTheOriginal) {
  const PointCloud cloud = flat_square();
  std::vector<Point3f> decoded = cloud.positions;
  decoded.pop_back();
  const CloudDifference difference = nearest_differences(ComparedSweep(cloud), decoded);
  EXPECT_EQ(difference.to_original.max_m(), 0);
  EXPECT_NEAR(difference.to_decoded.max_m(), 1, 1e-6);
  EXPECT_NEAR(difference.largest_nearest_m(), 1, 1e-6);
}

TEST(CloudDifference, OwnDistancesPairByIndex) {
  const PointCloud cloud = flat_square();
  std::vector<Point3f> decoded = cloud.positions;
  std::swap(decoded.front(), decoded.back());
  const Distances own = own_distances(cloud.positions, decoded);
  EXPECT_NEAR(own.max_m(), std::sqrt(2.0) * 19, 1e-4);
  EXPECT_EQ(nearest_differences(ComparedSweep(cloud), decoded).largest_nearest_m(), 0);
}

TEST(CloudDifference, QuantileOfKnownDistances) {
  Distances distances;
  for (int i = 100; i >= 1; --i) distances.each_m.push_back(static_cast<float>(i));
  EXPECT_EQ(distances.p95_m(), 95);
  EXPECT_NEAR(distances.mean_m(), 50.5, 1e-9);
  EXPECT_EQ(distances.max_m(), 100);
}

}  // namespace
}  // namespace pointreel
