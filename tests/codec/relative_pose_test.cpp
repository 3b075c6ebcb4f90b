#include "codec/relative_pose.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "base/trigonometry.h"

namespace pointreel {
namespace {

std::vector<std::uint8_t> bytes_of_floats(const std::vector<float>& values) {
  ByteWriter writer;
  for (const float value : values) writer.put(value);
  return writer.take();
}

Result<Pose> parse(const std::vector<std::uint8_t>& bytes) {
  ByteReader reader(bytes);
  return get_relative_pose(reader);
}

double angle_between(const Pose& a, const Pose& b) {
  return 2 * std::asin(std::min(1.0, (a.linear() - b.linear()).norm() / (2 * std::sqrt(2.0))));
}

TEST(RelativePose, ComesBackWithinItsPrecision) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    Pose pose = Pose::Identity();
    const double angle_rad = 0.5 * normal(random);
    pose.linear() =
        Eigen::AngleAxisd(angle_rad,
                          Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized())
            .toRotationMatrix();
    pose.translation() << 20 * normal(random), 20 * normal(random), normal(random);
    const auto back = quantised(pose);
    ASSERT_TRUE(back);
    EXPECT_LT(angle_between(*back, pose), 1e-6);
    EXPECT_LT((back->translation() - pose.translation()).norm(), 1e-5);
    EXPECT_LT((back->linear() * back->linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(RelativePose, HalfTurnsAreRotationsToo) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(Eigen::Vector3d::UnitZ()),
        Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(-0.3, 0.7, 0.2)}) {
    for (const double angle_rad : {kPi, kPi - 1e-9, -kPi + 1e-4}) {
      Pose pose = Pose::Identity();
      pose.linear() = Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
      const auto back = quantised(pose);
      ASSERT_TRUE(back);
      // w is the root of a small difference of float32 numbers here.
      EXPECT_LT(angle_between(*back, pose), 2e-3);
    }
  }
}

TEST(RelativePose, NonsenseIsAnError) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(parse(bytes_of_floats({0, 0, 0.5f, 1, 2, 3})));
  for (const auto& values : std::vector<std::vector<float>>{{nan, 0, 0, 0, 0, 0},
                                                            {0, infinity, 0, 0, 0, 0},
                                                            {0, 0, 1.1f, 0, 0, 0},
                                                            {0.8f, 0.8f, 0, 0, 0, 0},
                                                            {0, 0, 0, nan, 0, 0},
                                                            {0, 0, 0, 0, infinity, 0},
                                                            {0, 0, 0, 0, 0, -infinity}}) {
    const auto pose = parse(bytes_of_floats(values));
    ASSERT_FALSE(pose);
    EXPECT_EQ(pose.error().code, ErrorCode::corrupt);
  }
  for (std::size_t count = 0; count < 6; ++count) {
    const auto pose = parse(bytes_of_floats(std::vector<float>(count)));
    ASSERT_FALSE(pose);
    EXPECT_EQ(pose.error().code, ErrorCode::truncated);
  }
}

TEST(SweepMotion, ComesBackWithItsMotionPerTurn) {
  Pose pose = Pose::Identity();
  pose.translation() << 1.25, -0.5, 0.125;
  for (const double per_turn : {0.0, 1.0, -1.0, 0.3, -0.77}) {
    const auto back = quantised(SweepMotion{pose, per_turn});
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->T_ref_cur.isApprox(pose, 1e-12));
    EXPECT_NEAR(back->per_turn, per_turn, 1.0 / 128);
    EXPECT_EQ(quantised(*back)->per_turn, back->per_turn);
  }
}

TEST(SweepMotion, NonsenseIsAnError) {
  const auto parse_motion = [](int parts) {
    ByteWriter writer;
    put_relative_pose(writer, Pose::Identity());
    writer.put(static_cast<std::int8_t>(parts));
    ByteReader reader(writer.bytes());
    return get_sweep_motion(reader);
  };
  EXPECT_TRUE(parse_motion(64));
  EXPECT_TRUE(parse_motion(-64));
  for (const int parts : {65, 127, -65, -128}) {
    const auto motion = parse_motion(parts);
    ASSERT_FALSE(motion) << parts;
    EXPECT_EQ(motion.error().code, ErrorCode::corrupt);
  }
  ByteWriter pose_only;
  put_relative_pose(pose_only, Pose::Identity());
  ByteReader reader(pose_only.bytes());
  const auto motion = get_sweep_motion(reader);
  ASSERT_FALSE(motion);
  EXPECT_EQ(motion.error().code, ErrorCode::truncated);
}

}  // namespace
}  // namespace pointreel
