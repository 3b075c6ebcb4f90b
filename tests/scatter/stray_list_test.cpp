#include "scatter/stray_list.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "any_points.h"
#include "support/distance.h"

namespace pointreel {
namespace {

std::size_t check_strays(const std::vector<Stray>& strays, double max_error_m) {
  const std::size_t limit = strays.empty() ? 0 : strays.back().index + std::size_t{1};
  const auto bytes = encode_strays(strays, max_error_m);
  const auto decoded = decode_strays(bytes, max_error_m, limit);
  EXPECT_TRUE(decoded) << decoded.error().message;
  if (!decoded) return 0;
  EXPECT_EQ(decoded->size(), strays.size());
  for (std::size_t i = 0; i < std::min(decoded->size(), strays.size()); ++i) {
    const Point3f &a = strays[i].position, &b = (*decoded)[i].position;
    EXPECT_EQ((*decoded)[i].index, strays[i].index);
    if (is_finite(a)) {
      EXPECT_LE(distance_between_m(a, b), max_error_m);
    } else {
      EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
    }
  }
  if (!strays.empty()) {
    EXPECT_FALSE(decode_strays(bytes, max_error_m, limit - 1)) << "the last index is one too large";
  }
  return bytes.size();
}

TEST(StrayList, NoneTakeTwoBytes) {
  EXPECT_LE(check_strays({}, 0.02), 2u);
}

TEST(StrayList, MissingReturnsCostNextToNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Point3f& marker : {Point3f{}, Point3f{nan, nan, nan}, Point3f{-0.0f, 0, 0}}) {
    for (const std::uint32_t stride : {1u, 7u}) {
      std::vector<Stray> strays;
      for (std::uint32_t i = 0; i < 20'000; ++i) strays.push_back({5 + i * stride, marker});
      EXPECT_LT(8.0 * static_cast<double>(check_strays(strays, 0.02)) / 20'000, 0.05);
    }
  }
}

TEST(StrayList, MissingReturnsAmongOtherStraysCostFewBits) {
  std::mt19937 random(3);
  std::vector<Stray> strays;
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    strays.push_back({i, i % 100 == 0 ? Point3f{static_cast<float>(random() % 50), 2, 1} : Point3f{}});
  }
  EXPECT_LT(8.0 * static_cast<double>(check_strays(strays, 0.02)) / 10'000, 0.6);
}

RC_GTEST_PROP(StrayList, KeepsTheBoundOnAnyPoints, ()) {
  const auto positions = *any_points();
  std::vector<Stray> strays;
  std::uint32_t index = 0;
  for (const Point3f& position : positions) {
    index += *rc::gen::inRange(0u, 3u);
    strays.push_back({index++, position});
    if (index % 4 == 0) strays.push_back({index++, position});
  }
  check_strays(strays, *rc::gen::element(0.0005, 0.02, 1.0));
}

TEST(StrayList, SurvivesDamage) {
  std::mt19937 random(7);
  std::vector<Stray> strays;
  for (std::uint32_t i = 0; i < 300; ++i) {
    strays.push_back({3 * i + static_cast<std::uint32_t>(random() % 3),
                      {static_cast<float>(random() % 900) / 7, 1, i % 20 == 0 ? 3e38f : -1.5f}});
  }
  const auto bytes = encode_strays(strays, 0.02);
  for (int trial = 0; trial < 2000; ++trial) {
    auto damaged = bytes;
    if (trial % 3 == 0) damaged.resize(random() % damaged.size());
    if (trial % 3 == 1) damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    if (trial % 3 == 2) {
      for (auto& byte : damaged) byte = static_cast<std::uint8_t>(random());
    }
    const auto decoded = decode_strays(damaged, 0.02, 1000);
    if (!decoded) {
      EXPECT_FALSE(decoded.error().message.empty());
      continue;
    }
    for (std::size_t i = 0; i < decoded->size(); ++i) {
      EXPECT_LT((*decoded)[i].index, 1000u);
      if (i == 0) continue;
      EXPECT_LT((*decoded)[i - 1].index, (*decoded)[i].index);
    }
  }
}

}  // namespace
}  // namespace pointreel
