// encode() and decode() of whole drives.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pointreel/pointreel.h"
#include "support/clouds.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

std::vector<PointCloud> drive(int frames) {
  std::vector<PointCloud> sweeps;
  for (SimulatedSweep& sweep : simulated_drive(frames)) sweeps.push_back(std::move(sweep.cloud));
  return sweeps;
}

TEST(OneCall, GivesEverySweepBackWithinTheBound) {
  auto sweeps = drive(3);
  sweeps[1].positions[5].x = std::numeric_limits<float>::quiet_NaN();
  sweeps.push_back({});
  const EncoderOptions options;
  const auto bytes = encode(sweeps, options);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto decoded = decode(*bytes);
  ASSERT_TRUE(decoded) << decoded.error().message;
  ASSERT_EQ(decoded->size(), sweeps.size());
  StreamHeader header;
  header.max_error_m = options.mixture.max_error_m;
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    EXPECT_EQ((*decoded)[k].frame, k);
    const auto& positions = (*decoded)[k].cloud.positions;
    const auto pairs = pair_points(header, sweeps[k], (*decoded)[k]);
    ASSERT_TRUE(pairs) << pairs.error().message;
    for (std::size_t i = 0; i < sweeps[k].size(); ++i) {
      const Point3f& p = sweeps[k].positions[i];
      if (!is_finite(p)) continue;
      ASSERT_GE((*pairs)[i], 0);
      const Point3f& q = positions[static_cast<std::size_t>((*pairs)[i])];
      ASSERT_LE(std::hypot(double{p.x} - double{q.x}, double{p.y} - double{q.y}, double{p.z} - double{q.z}),
                options.mixture.max_error_m);
    }
  }
}

TEST(OneCall, PlanesComeInTheOrderOfTheSweeps) {
  EncoderOptions options;
  options.method = Method::planes;
  options.planes.grid = PlaneGrid::uniform;
  options.planes.group = 3;
  const auto sweeps = drive(4);
  const std::vector<Pose> poses(4, Pose::Identity());
  const auto bytes = encode(sweeps, options, poses);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto decoded = decode(*bytes);
  ASSERT_TRUE(decoded) << decoded.error().message;
  ASSERT_EQ(decoded->size(), 4u);
  for (std::uint32_t k = 0; k < 4; ++k) EXPECT_EQ((*decoded)[k].frame, k);
}

TEST(OneCall, NoSweepsAreAnEmptyReel) {
  const auto bytes = encode({});
  ASSERT_TRUE(bytes);
  const auto decoded = decode(*bytes);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_TRUE(decoded->empty());
}

TEST(OneCall, ThreadsChangeNoByte) {
  const auto sweeps = drive(2);
  const auto alone = encode(sweeps, {}, {}, Runtime{1});
  const auto together = encode(sweeps, {}, {}, Runtime{3});
  ASSERT_TRUE(alone && together);
  EXPECT_EQ(*alone, *together);
}

TEST(OneCall, ErrorsNameWhatIsWrong) {
  auto sweeps = drive(1);
  EncoderOptions options;
  options.mixture.max_error_m = 0;
  expect_error(encode(sweeps, options), ErrorCode::invalid_argument, "max-error");
  expect_error(encode(sweeps, {}, std::vector<Pose>(2, Pose::Identity())), ErrorCode::invalid_argument,
               "2 poses for 1 sweeps");
  sweeps[0].fields.push_back({"ring", std::vector<std::uint8_t>(3)});
  expect_error(encode(sweeps), ErrorCode::invalid_argument, "field ring has 3 values");
  sweeps[0].fields.pop_back();
  const auto bytes = encode(sweeps);
  ASSERT_TRUE(bytes);
  expect_error(decode({}), ErrorCode::truncated, "reel");
  expect_error(decode(std::span(*bytes).first(bytes->size() - 1)), ErrorCode::truncated, "index");
  auto damaged = *bytes;
  damaged[damaged.size() / 2] ^= 4;
  expect_error(decode(damaged), ErrorCode::corrupt, "packet at byte");
}

}  // namespace
}  // namespace pointreel
