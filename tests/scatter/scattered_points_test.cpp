#include "scatter/scattered_points.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>

#include "any_points.h"
#include "support/clouds.h"
#include "support/distance.h"

namespace pointreel {
namespace {

// Every point against its own original, no point twice. Returns the bytes.
std::size_t check(const std::vector<Point3f>& points, double max_error_m) {
  const ScatteredPoints coded = encode_scattered(points, max_error_m);
  const auto decoded = decode_scattered(coded.bytes, max_error_m, points.size());
  EXPECT_TRUE(decoded) << decoded.error().message;
  if (!decoded) return 0;
  EXPECT_EQ(decoded->size(), points.size());
  EXPECT_EQ(coded.order.size(), points.size());
  std::vector<bool> seen(points.size(), false);
  for (std::size_t i = 0; i < decoded->size(); ++i) {
    const Point3f& original = points[coded.order[i]];
    EXPECT_FALSE(seen[coded.order[i]]);
    seen[coded.order[i]] = true;
    if (is_finite(original)) {
      EXPECT_LE(distance_between_m((*decoded)[i], original), max_error_m);
    } else {
      EXPECT_EQ(std::memcmp(&(*decoded)[i], &original, sizeof(Point3f)), 0);
    }
  }
  if (!points.empty()) {
    EXPECT_FALSE(decode_scattered(coded.bytes, max_error_m, points.size() - 1)) << "one point too many";
  }
  return coded.bytes.size();
}

TEST(ScatteredPoints, KeepTheBoundOnAwkwardClouds) {
  for (const auto& [name, cloud] : awkward_clouds()) {
    for (const double max_error_m : {1e-6, 0.0005, 0.02, 1.0, 1e9}) {
      SCOPED_TRACE(name + " " + std::to_string(max_error_m));
      check(cloud.positions, max_error_m);
    }
  }
}

RC_GTEST_PROP(ScatteredPoints, KeepTheBoundOnAnyPoints, ()) {
  const auto points = *any_points();
  const double max_error_m = *rc::gen::element(0.0005, 0.01, 0.3, 1.0);
  auto twice = points;
  twice.insert(twice.end(), points.begin(), points.end());
  check(twice, max_error_m);
}

TEST(ScatteredPoints, EqualPointsCostNextToNothing) {
  EXPECT_LT(check(std::vector<Point3f>(100'000, {3, 4, -1}), 0.01), 40u);
}

TEST(ScatteredPoints, ASurfaceCostsFewBits) {
  std::vector<Point3f> points;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-20, 20);
  for (int i = 0; i < 50'000; ++i) points.push_back({place(random), place(random), -1.7f});
  // 1600 m^2 in cells of 11.5 cm: most are taken, 0.41 points in each.
  EXPECT_LT(8.0 * static_cast<double>(check(points, 0.1)) / 50'000, 4.0);
}

TEST(ScatteredPoints, SurviveDamage) {
  const auto cloud = random_sphere(2000, 12, 4);
  const auto bytes = encode_scattered(cloud.positions, 0.02).bytes;
  std::mt19937 random(5);
  const auto survive = [&](std::span<const std::uint8_t> damaged) {
    const auto decoded = decode_scattered(damaged, 0.02, 3000);
    if (decoded) {
      EXPECT_LE(decoded->size(), 3000u);
    } else {
      EXPECT_FALSE(decoded.error().message.empty());
    }
  };
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 60) {
    survive(std::span(bytes).first(length));
  }
  for (int trial = 0; trial < 150; ++trial) {
    auto damaged = bytes;
    damaged[random() % (trial % 2 == 0 ? 20 : damaged.size())] ^=
        static_cast<std::uint8_t>(1u << random() % 8);
    survive(damaged);
    for (auto& byte : damaged) byte = static_cast<std::uint8_t>(random());
    survive(damaged);
  }
}

}  // namespace
}  // namespace pointreel
