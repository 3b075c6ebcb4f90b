// Encoder::encode_all: the packets and errors of one call a sweep.
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <span>

#include "support/clouds.h"
#include "support/codec_round_trip.h"

namespace pointreel {
namespace {

// A drive with sweeps in between that have no grid, no point, points that are not finite, or broken fields.
std::vector<PosedSweep> mixed_drive(bool with_poses) {
  auto drive = simulated_drive(9);
  std::vector<PosedSweep> sweeps;
  for (SimulatedSweep& sweep : drive) {
    sweeps.push_back({std::move(sweep.cloud), {}});
    if (with_poses) sweeps.back().T_world_sensor = sweep.T_world_sensor;
  }
  sweeps[2].cloud.positions[7].x = std::numeric_limits<float>::quiet_NaN();
  sweeps[4].cloud = random_sphere(500, 20, 1);
  sweeps[5].cloud.fields.push_back({"broken", std::vector<float>(3)});
  sweeps[7].cloud = {};
  return sweeps;
}

std::vector<Encoder::Packets> encode_one_by_one(Encoder& encoder, const std::vector<PosedSweep>& sweeps) {
  std::vector<Encoder::Packets> packets;
  packets.reserve(sweeps.size());
  for (const auto& [cloud, pose] : sweeps) packets.push_back(encoder.encode(cloud, pose));
  return packets;
}

void expect_same(const std::vector<Encoder::Packets>& packets,
                 const std::vector<Encoder::Packets>& expected) {
  ASSERT_EQ(packets.size(), expected.size());
  for (std::size_t i = 0; i < packets.size(); ++i) {
    SCOPED_TRACE("sweep " + std::to_string(i));
    ASSERT_EQ(static_cast<bool>(packets[i]), static_cast<bool>(expected[i]));
    if (!packets[i]) {
      EXPECT_EQ(packets[i].error().code, expected[i].error().code);
      EXPECT_EQ(packets[i].error().message, expected[i].error().message);
      continue;
    }
    ASSERT_EQ(packets[i]->size(), expected[i]->size());
    for (std::size_t p = 0; p < packets[i]->size(); ++p)
      EXPECT_EQ(serialize((*packets[i])[p]), serialize((*expected[i])[p]));
  }
}

// The first of the sweeps, until there are no more or `wanted` results have come.
std::vector<Encoder::Packets> encode_all_of(Encoder& encoder, std::span<PosedSweep> sweeps,
                                            std::size_t wanted) {
  std::vector<Encoder::Packets> packets;
  std::size_t given = 0;
  encoder.encode_all(
      [&]() -> std::optional<PosedSweep> {
        if (given == sweeps.size()) return std::nullopt;
        return std::move(sweeps[given++]);
      },
      [&](Encoder::Packets taken) {
        packets.push_back(std::move(taken));
        return packets.size() < wanted;
      });
  return packets;
}

void check_sequences(const EncoderOptions& options, bool with_poses) {
  auto plain = Encoder::create(options, Runtime{1});
  const auto expected = encode_one_by_one(*plain, mixed_drive(with_poses));
  const auto last = plain->finish();
  EXPECT_FALSE(expected[5]);
  for (const int threads : {1, 2, 3}) {
    for (const std::size_t first_call : {0u, 5u, 9u}) {
      SCOPED_TRACE(testing::Message() << threads << " threads, " << first_call << " sweeps at first");
      auto sweeps = mixed_drive(with_poses);
      auto encoder = Encoder::create(options, Runtime{threads});
      auto packets = encode_all_of(*encoder, std::span(sweeps).first(first_call), sweeps.size());
      for (auto& more : encode_all_of(*encoder, std::span(sweeps).subspan(first_call), sweeps.size()))
        packets.push_back(std::move(more));
      expect_same(packets, expected);
      expect_same({encoder->finish()}, {last});
    }
  }
}

TEST(EncodeAll, GivesThePacketsOfOneCallASweep) {
  for (const Effort effort : {Effort::fast, Effort::balanced, Effort::max}) {
    SCOPED_TRACE(testing::Message() << "effort " << static_cast<int>(effort));
    EncoderOptions options;
    options.mixture.effort = effort;
    options.mixture.group = effort == Effort::max ? 10 : 2;
    check_sequences(options, effort == Effort::max);
  }
}

TEST(EncodeAll, GivesThemForPlanesOnEitherGrid) {
  EncoderOptions options;
  options.method = Method::planes;
  check_sequences(options, false);
  options.planes.grid = PlaneGrid::uniform;
  options.planes.group = 2;
  check_sequences(options, true);
}

TEST(EncodeAll, StopsWhenNoMoreIsWanted) {
  for (const int threads : {1, 2}) {
    auto sweeps = mixed_drive(false);
    auto encoder = Encoder::create({}, Runtime{threads});
    EXPECT_EQ(encode_all_of(*encoder, sweeps, 2).size(), 2u);
  }
}

}  // namespace
}  // namespace pointreel
