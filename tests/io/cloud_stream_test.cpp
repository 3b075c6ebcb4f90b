// Where a sweep in a stream ends.
#include "io/cloud_stream.h"

#include <gtest/gtest.h>

#include "io/formats.h"
#include "support/clouds.h"
#include "support/expect_error.h"

namespace pointreel::io {
namespace {

TEST(CloudStream, FindsTheEndOfEverySweep) {
  const PointCloud cloud = random_sphere(100, 5, 1);
  const auto pcd = serialize_pcd(cloud, CloudEncoding::binary);
  const auto ply = serialize_ply(cloud, CloudEncoding::binary);
  const auto nothing = serialize_pcd({}, CloudEncoding::binary);
  for (const auto& [bytes, format] : {std::pair(*pcd, CloudFormat::pcd), std::pair(*ply, CloudFormat::ply),
                                      std::pair(*nothing, CloudFormat::pcd)}) {
    for (const std::string& next : {std::string(), *pcd, *ply}) {
      const auto leading = leading_cloud(bytes + next, "stream");
      ASSERT_TRUE(leading && *leading);
      EXPECT_EQ((*leading)->format, format);
      EXPECT_EQ((*leading)->bytes, bytes.size());
    }
  }
}

TEST(CloudStream, KnowsNothingBeforeTheHeaderIsWhole) {
  for (const auto& whole : {serialize_pcd(random_sphere(10, 5, 1), CloudEncoding::binary),
                            serialize_ply(random_sphere(10, 5, 1), CloudEncoding::binary)}) {
    bool known = false;
    for (std::size_t length = 0; length <= whole->size(); ++length) {
      const auto leading = leading_cloud(whole->substr(0, length), "stream");
      ASSERT_TRUE(leading) << leading.error().message;
      EXPECT_TRUE(leading->has_value() || !known);
      known = leading->has_value();
      if (known) {
        EXPECT_EQ((*leading)->bytes, whole->size());
      }
    }
    EXPECT_TRUE(known);
  }
}

TEST(CloudStream, RefusesWhatDoesNotTellItsEnd) {
  const PointCloud cloud = random_sphere(10, 5, 1);
  expect_error(leading_cloud(*serialize_pcd(cloud, CloudEncoding::ascii), "stream"), ErrorCode::unsupported,
               {"stream, line 11: ", "DATA binary"});
  expect_error(leading_cloud(*serialize_pcd(cloud, CloudEncoding::binary_compressed), "stream"),
               ErrorCode::unsupported, {"DATA binary"});
  expect_error(leading_cloud(*serialize_ply(cloud, CloudEncoding::ascii), "stream"), ErrorCode::unsupported,
               {"binary PLY"});
  expect_error(
      leading_cloud(
          "ply\nformat binary_little_endian 1.0\nelement face 3\nproperty list uchar int i\nend_header\n",
          "stream"),
      ErrorCode::unsupported, {"'face' has a list"});
  expect_error(leading_cloud(std::string(32, '\0'), "stream"), ErrorCode::unsupported,
               {"no PCD or PLY file"});
  expect_error(leading_cloud("#" + std::string(70'000, ' '), "stream"), ErrorCode::corrupt,
               {"does not end within"});
  expect_error(
      leading_cloud("FIELDS x\nSIZE 8\nTYPE F\nPOINTS 18446744073709551615\nDATA binary\n", "stream"),
      ErrorCode::resource_limit, {"more than the limit"});
}

}  // namespace
}  // namespace pointreel::io
