// Method `mixture` over time: sweeps predicted from the one before, efforts, lost packets.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "support/clouds.h"
#include "support/expect_error.h"
#include "support/mixture_round_trip.h"

namespace pointreel {
namespace {

class Temporal : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto drive = simulated_drive(7);
    sweeps_ = clouds_of(drive);
    poses_ = poses_of(drive);
  }
  static EncoderOptions options_with(Effort effort, int group = 10, bool temporal = true) {
    EncoderOptions options = mixture_options(0.02, group);
    options.mixture.effort = effort;
    options.mixture.temporal = temporal;
    return options;
  }
  static std::size_t bytes_of(const std::vector<Packet>& packets) {
    std::size_t bytes = 0;
    for (const Packet& packet : packets) bytes += packet.payload.size();
    return bytes;
  }

  static inline std::vector<PointCloud> sweeps_;
  static inline std::vector<Pose> poses_;
};

TEST_F(Temporal, EveryEffortAndGroupKeepsEveryPromise) {
  for (const Effort effort : {Effort::fast, Effort::balanced, Effort::max}) {
    for (const int group : {1, 3, 10}) {
      SCOPED_TRACE(testing::Message() << "effort " << static_cast<int>(effort) << ", group " << group);
      check_mixture_round_trip(sweeps_, options_with(effort, group));
    }
  }
}

TEST_F(Temporal, PredictedSweepsNameTheOneBefore) {
  const auto packets = encode_all(sweeps_, options_with(Effort::balanced, 3));
  for (const Packet& packet : packets) {
    EXPECT_EQ(packet.kind == FrameKind::key, packet.frame % 3 == 0);
    EXPECT_EQ(packet.group, packet.frame / 3);
    EXPECT_EQ(packet.reference_frame, packet.frame % 3 == 0 ? packet.frame : packet.frame - 1);
  }
}

TEST_F(Temporal, DecodedSweepsSayWhetherTheOneBeforeWasUsed) {
  for (const bool temporal : {true, false}) {
    const auto options = options_with(Effort::balanced, 2, temporal);
    for (const auto& sweep : decoder_of(options).decode(encode_all(sweeps_, options)))
      EXPECT_EQ(sweep->temporal, temporal && sweep->frame % 2 == 1) << "frame " << sweep->frame;
  }
}

TEST_F(Temporal, TheSweepBeforeSavesBytesAndMoreWorkSavesMore) {
  const auto balanced = bytes_of(encode_all(sweeps_, options_with(Effort::balanced)));
  EXPECT_LT(balanced, bytes_of(encode_all(sweeps_, options_with(Effort::balanced, 10, false))));
  EXPECT_LT(balanced, bytes_of(encode_all(sweeps_, options_with(Effort::fast))));
  EXPECT_LT(static_cast<double>(bytes_of(encode_all(sweeps_, options_with(Effort::max)))),
            1.01 * static_cast<double>(balanced));
}

TEST_F(Temporal, PosesAreTakenAndWrongOnesDoNoHarm) {
  const auto options = options_with(Effort::balanced);
  const auto own = bytes_of(encode_all(sweeps_, options));
  std::vector<Pose> wrong = poses_;
  for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i].translation().y() += 30.0 * static_cast<double>(i);
  for (const auto& poses : {poses_, wrong}) {
    const auto packets = encode_all(sweeps_, options, poses);
    EXPECT_LT(static_cast<double>(bytes_of(packets)), 1.03 * static_cast<double>(own));
    const auto decoded = decoder_of(options).decode(packets);
    for (std::size_t i = 0; i < packets.size(); ++i)
      check_mixture_sweep(header_of(options), sweeps_[i], packets[i], *decoded[i]);
  }
}

// From one place to another and back: nothing to register.
TEST_F(Temporal, JumpsKeepTheBound) {
  const auto elsewhere = clouds_of(simulated_drive(40));
  check_mixture_round_trip(
      {sweeps_[0], elsewhere[39], sweeps_[1], random_sphere(3000, 20, 1), sweeps_[2], sweeps_[3]},
      options_with(Effort::balanced));
}

TEST_F(Temporal, BytesAreTheSameForAnyNumberOfThreads) {
  for (const Effort effort : {Effort::fast, Effort::balanced, Effort::max}) {
    const auto one = encode_all(sweeps_, options_with(effort), {}, 1);
    const auto sweeps = decoder_of(options_with(effort), 1).decode(one);
    for (const int threads : {2, 3}) {
      const auto packets = encode_all(sweeps_, options_with(effort), {}, threads);
      const auto decoded = decoder_of(options_with(effort), threads).decode(packets);
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(serialize(packets[i]), serialize(one[i]));
        EXPECT_EQ(decoded[i]->cloud.positions, sweeps[i]->cloud.positions);
      }
    }
  }
}

TEST_F(Temporal, ALostPacketCostsTheRestOfItsGroup) {
  const auto options = options_with(Effort::balanced, 4);
  const auto packets = encode_all(sweeps_, options);  // groups 0 to 3, 4 to 6
  const auto whole = decoder_of(options).decode(packets);
  std::vector<Packet> received = packets;
  received.erase(received.begin() + 1);
  const auto sweeps = decoder_of(options).decode(received);
  ASSERT_TRUE(sweeps[0]);
  expect_error(sweeps[1], ErrorCode::corrupt, {"frame 2", "reference frame 1 was not decoded"});
  expect_error(sweeps[2], ErrorCode::corrupt, {"frame 3", "reference frame 2 was not decoded"});
  for (const std::size_t kept : {3u, 4u, 5u}) {
    ASSERT_TRUE(sweeps[kept]);
    EXPECT_EQ(sweeps[kept]->cloud.positions, whole[kept + 1]->cloud.positions);
  }
}

// What its points give away is damaged as a whole: the next sweep is not predicted from its cells either.
TEST_F(Temporal, ASweepWithDamagedPointsIsNoReference) {
  for (const Effort effort : {Effort::fast, Effort::balanced}) {
    const auto options = options_with(effort, 3);  // frames 0 1 2, 3 4 5, 6
    auto packets = encode_all(sweeps_, options);
    packets[1].payload.push_back(0);
    for (const int threads : {1, 2}) {
      const auto sweeps = decoder_of(options, threads).decode(packets);
      expect_error(sweeps[1], ErrorCode::corrupt, {"frame 1", "bytes follow"});
      if (effort == Effort::balanced)
        expect_error(sweeps[2], ErrorCode::corrupt, {"frame 2", "reference frame 1 was not decoded"});
      else
        EXPECT_TRUE(sweeps[2]);
      for (const std::size_t whole : {0u, 3u, 4u, 5u, 6u}) EXPECT_TRUE(sweeps[whole]) << whole;
    }
  }
}

// Decoded in one call of any number of threads or packet by packet; with all packets, without one of a group,
// with a damaged key frame, and with one whose cells can be decoded but not its points, before another
// damaged one.
TEST_F(Temporal, GroupsDecodeSideBySideAsTheyDoOneAfterTheOther) {
  for (const Effort effort : {Effort::fast, Effort::balanced}) {
    const auto options = options_with(effort, 2);  // frames 0 1, 2 3, 4 5, 6
    const auto whole = encode_all(sweeps_, options);
    std::vector<Packet> without_key = whole, damaged = whole, spoilt = whole, without_first = whole;
    without_key.erase(without_key.begin() + 4);
    damaged[2].payload.resize(damaged[2].payload.size() / 2);
    spoilt[4].payload.push_back(0);
    spoilt[5].payload.resize(spoilt[5].payload.size() / 2);
    without_first.erase(without_first.begin());
    for (const auto& packets : {whole, without_key, damaged, spoilt, without_first}) {
      auto one_by_one = decoder_of(options, 1);
      std::vector<Result<DecodedSweep>> expected;
      expected.reserve(packets.size());
      for (const Packet& packet : packets) expected.push_back(std::move(one_by_one.decode({&packet, 1})[0]));
      for (const int threads : {1, 2, 3, 8}) {
        for (const std::size_t first_call : {packets.size(), std::size_t{3}}) {
          SCOPED_TRACE(testing::Message() << threads << " threads, " << first_call << " packets at first");
          auto decoder = decoder_of(options, threads);
          auto sweeps = decoder.decode(std::span(packets).first(first_call));
          for (auto& sweep : decoder.decode(std::span(packets).subspan(first_call)))
            sweeps.push_back(std::move(sweep));
          ASSERT_EQ(sweeps.size(), expected.size());
          for (std::size_t i = 0; i < sweeps.size(); ++i) {
            ASSERT_EQ(static_cast<bool>(sweeps[i]), static_cast<bool>(expected[i])) << i;
            if (sweeps[i]) {
              EXPECT_EQ(sweeps[i]->frame, expected[i]->frame);
              EXPECT_EQ(sweeps[i]->cloud.positions, expected[i]->cloud.positions);
            } else {
              EXPECT_EQ(sweeps[i].error().message, expected[i].error().message);
            }
          }
        }
      }
    }
  }
}

// One key frame a second, 5 % of the packets gone: a chain of ten keeps 76 % on average.
TEST_F(Temporal, RandomLossesAreReportedAndMostSweepsArrive) {
  const auto drive = clouds_of(simulated_drive(60));
  const auto options = options_with(Effort::balanced, 10);
  const auto packets = encode_all(drive, options);
  std::mt19937 random(5);
  std::size_t sent = 0, arrived = 0;
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<Packet> received;
    for (const Packet& packet : packets) {
      if (random() % 20 != 0) received.push_back(packet);
    }
    auto decoder = decoder_of(options);
    const auto sweeps = decoder.decode(received);
    ASSERT_EQ(sweeps.size(), received.size());
    sent += packets.size();
    for (std::size_t i = 0; i < received.size(); ++i) {
      if (!sweeps[i]) {
        expect_error(sweeps[i], ErrorCode::corrupt,
                     {"frame " + std::to_string(received[i].frame), "not decoded"});
        continue;
      }
      ++arrived;
      if (trial == 0)
        check_mixture_sweep(header_of(options), drive[received[i].frame], received[i], *sweeps[i]);
    }
  }
  EXPECT_GT(static_cast<double>(arrived), 0.7 * static_cast<double>(sent));
}

TEST_F(Temporal, AnUnknownEffortIsAnError) {
  EncoderOptions options;
  options.mixture.effort = static_cast<Effort>(3);
  expect_error(Encoder::create(options), ErrorCode::invalid_argument, {"effort 3"});
}

}  // namespace
}  // namespace pointreel
