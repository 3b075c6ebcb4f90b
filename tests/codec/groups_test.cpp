// Groups of sweeps of a simulated drive: sizes, threads, poses, lost packets.
#include <gtest/gtest.h>

#include "support/clouds.h"
#include "support/codec_round_trip.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

class Groups : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto drive = simulated_drive(7);
    sweeps_ = clouds_of(drive);
    poses_ = poses_of(drive);
  }

  static EncoderOptions options_with_group(int group) {
    EncoderOptions options = planes_options();
    options.planes.group = group;
    options.planes.elevation_step_rad = 2 * kDegree;  // the sensor's own
    return options;
  }

  static constexpr double kDegree = 3.14159265358979323846 / 180;
  static inline std::vector<PointCloud> sweeps_;
  static inline std::vector<Pose> poses_;
};

TEST_F(Groups, OfAnySizeKeepEveryPromise) {
  for (const int group : {1, 2, 5, 19}) {
    SCOPED_TRACE("group of " + std::to_string(group));
    check_round_trip(sweeps_, options_with_group(group));
    check_round_trip(sweeps_, options_with_group(group), poses_);
  }
}

TEST_F(Groups, TheMiddleSweepIsTheKeyFrameAndComesFirst) {
  const auto packets = encode_all(sweeps_, options_with_group(5));
  std::vector<std::uint32_t> frames, groups, references;
  for (const Packet& packet : packets) {
    frames.push_back(packet.frame);
    groups.push_back(packet.group);
    references.push_back(packet.reference_frame);
    EXPECT_EQ(packet.kind == FrameKind::key, packet.reference_frame == packet.frame);
  }
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{2, 0, 1, 3, 4, 6, 5}));
  EXPECT_EQ(groups, (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(references, (std::vector<std::uint32_t>{2, 2, 2, 2, 2, 6, 6}));
}

TEST_F(Groups, PacketsComeWhenTheirGroupIsFull) {
  auto encoder = Encoder::create(options_with_group(3));
  ASSERT_TRUE(encoder);
  std::vector<std::size_t> counts;
  counts.reserve(sweeps_.size() + 2);
  for (const PointCloud& sweep : sweeps_) counts.push_back(encoder->encode(sweep)->size());
  counts.push_back(encoder->finish()->size());
  counts.push_back(encoder->finish()->size());
  EXPECT_EQ(counts, (std::vector<std::size_t>{0, 0, 3, 0, 0, 3, 0, 1, 0}));
}

TEST_F(Groups, BytesAreTheSameForAnyNumberOfThreads) {
  for (const int group : {1, 5}) {
    const auto one = encode_all(sweeps_, options_with_group(group), poses_, 1);
    const auto sweeps = decoder_of(options_with_group(group), 1).decode(one);
    for (const int threads : {2, 3, 8}) {
      const auto packets = encode_all(sweeps_, options_with_group(group), poses_, threads);
      ASSERT_EQ(packets.size(), one.size());
      for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(serialize(packets[i]), serialize(one[i]));
      const auto decoded = decoder_of(options_with_group(group), threads).decode(packets);
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(decoded[i]->cloud.positions, sweeps[i]->cloud.positions);
      }
    }
  }
}

TEST_F(Groups, PacketsDecodeAloneAsTheyDoTogether) {
  const auto packets = encode_all(sweeps_, options_with_group(3));
  const auto together = decoder_of(options_with_group(3)).decode(packets);
  auto decoder = decoder_of(options_with_group(3));
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const auto alone = decoder.decode({&packets[i], 1});
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0]->cloud.positions, together[i]->cloud.positions);
  }
  EXPECT_TRUE(decoder.decode({}).empty());
}

TEST_F(Groups, ADriveStartsOverInASecondEncoderWithTheSameBytes) {
  const auto first = encode_all(sweeps_, options_with_group(2)),
             second = encode_all(sweeps_, options_with_group(2));
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(serialize(first[i]), serialize(second[i]));
}

TEST_F(Groups, PosesMakeMovingSweepsSmaller) {
  // From the same place again and again, 4 m apart: motion is everything here.
  const auto total = [](const std::vector<Packet>& packets) {
    std::size_t bytes = 0;
    for (const Packet& packet : packets) bytes += packet.payload.size();
    return bytes;
  };
  const std::vector<PointCloud> same(5, sweeps_[3]);
  std::vector<Pose> standing(5, poses_[3]), driving = standing;
  for (int i = 0; i < 5; ++i) driving[static_cast<std::size_t>(i)].translation().x() += 4 * i;
  EXPECT_EQ(total(encode_all(same, options_with_group(5))),
            total(encode_all(same, options_with_group(5), standing)));
  EXPECT_LT(total(encode_all(same, options_with_group(5), standing)),
            total(encode_all(same, options_with_group(5), driving)));
}

TEST_F(Groups, DecodedPointsAreInTheSweepsOwnCoordinatesWhateverThePoses) {
  EncoderOptions options = options_with_group(2);
  const Pose later =
      poses_[0] * Eigen::Translation3d(3, -0.5, 0.1) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ());
  const auto decoded =
      decoder_of(options).decode(encode_all({sweeps_[0], sweeps_[6]}, options, {poses_[0], later}));
  const DecodedSweep& moved = *decoded[1];
  EXPECT_EQ(moved.frame, 0u);
  const Pose expected = later.inverse() * poses_[0];
  EXPECT_LT((moved.T_key_sensor.matrix() - expected.matrix()).norm(), 1e-5);
  EXPECT_LT((decoded[0]->T_key_sensor.matrix() - Pose::Identity().matrix()).norm(), 1e-15);
}

TEST_F(Groups, AMissingKeyFrameCostsItsGroupOnly) {
  const auto packets = encode_all(sweeps_, options_with_group(3));  // 1 0 2, 4 3 5, 6
  const auto whole = decoder_of(options_with_group(3)).decode(packets);
  std::vector<Packet> received = packets;
  received.erase(received.begin() + 3);
  const auto sweeps = decoder_of(options_with_group(3)).decode(received);
  ASSERT_EQ(sweeps.size(), 6u);
  for (const std::size_t lost : {3u, 4u}) {
    expect_error(sweeps[lost], ErrorCode::corrupt,
                 {"frame " + std::to_string(received[lost].frame), "reference frame 4 was not decoded"});
  }
  for (const std::size_t kept : {0u, 1u, 2u}) {
    ASSERT_TRUE(sweeps[kept]);
    EXPECT_EQ(sweeps[kept]->cloud.positions, whole[kept]->cloud.positions);
  }
  ASSERT_TRUE(sweeps[5]);
  EXPECT_EQ(sweeps[5]->cloud.positions, whole[6]->cloud.positions);
}

TEST_F(Groups, ADamagedKeyFrameIsNoReferenceAndADamagedPredictedFrameHarmsNobody) {
  const auto packets = encode_all(sweeps_, options_with_group(3));
  auto damaged_key = packets;
  damaged_key[0].payload.resize(10);
  auto sweeps = decoder_of(options_with_group(3)).decode(damaged_key);
  for (const std::size_t lost : {0u, 1u, 2u}) EXPECT_FALSE(sweeps[lost]);
  for (const std::size_t kept : {3u, 4u, 5u, 6u}) EXPECT_TRUE(sweeps[kept]);

  auto damaged_predicted = packets;
  damaged_predicted[1].payload.resize(10);
  sweeps = decoder_of(options_with_group(3)).decode(damaged_predicted);
  expect_error(sweeps[1], ErrorCode::truncated, {"frame 0", "pose"});
  for (const std::size_t kept : {0u, 2u, 3u, 4u, 5u, 6u}) EXPECT_TRUE(sweeps[kept]);
}

TEST_F(Groups, AWrongCountOfPointsIsAnError) {
  auto packets = encode_all(sweeps_, options_with_group(1));
  --packets[2].points_out;
  const auto sweeps = decoder_of(options_with_group(1)).decode(packets);
  expect_error(sweeps[2], ErrorCode::corrupt, {"frame 2", "points instead of"});
  EXPECT_TRUE(sweeps[3]);
}

TEST_F(Groups, PairingWithAnotherSweepIsAnError) {
  const auto options = options_with_group(1);
  const auto sweeps = decoder_of(options).decode(encode_all(sweeps_, options));
  expect_error(pair_points(header_of(options), random_sphere(500, 10, 1), *sweeps[0]),
               ErrorCode::invalid_argument, {"frame 0", "not the same sweep"});
}

}  // namespace
}  // namespace pointreel
