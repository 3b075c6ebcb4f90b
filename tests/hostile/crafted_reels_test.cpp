// Reels made to hurt: each value valid by itself, together asking for as much as they can.
#include <limits>

#include "base/bytes.h"
#include "planes/frame_coding.h"
#include "planes/projection.h"
#include "survival.h"

namespace pointreel {
namespace {

constexpr int kFinestRows = 10472, kFinestColumns = 20944;  // of steps of 0.0003 rad

StreamHeader finest_header(int tile_size = 2) {
  StreamHeader header;
  header.method = Method::planes;
  header.planes.grid = PlaneGrid::uniform;
  header.planes.azimuth_step_rad = header.planes.elevation_step_rad = 0.0003;
  header.planes.tile_size = tile_size;
  header.planes.residual_step_m = 0.2;
  return header;
}

// `fill` again and again, behind the claim of `tile_rows` rows of tiles. To the range decoder zeros say yes
// to every question (cell occupied, run goes on) and 0xFF says no.
std::vector<std::uint8_t> frame_payload(int first_tile_row, int tile_rows, std::size_t bytes,
                                        std::uint8_t fill) {
  ByteWriter writer;
  writer.put(static_cast<std::uint16_t>(first_tile_row));
  writer.put(static_cast<std::uint16_t>(tile_rows));
  const std::vector<std::uint8_t> filling(bytes, fill);
  writer.put(std::span(filling));
  return writer.take();
}

Packet crafted_packet(std::uint32_t frame, std::uint32_t reference, std::vector<std::uint8_t> payload,
                      std::uint32_t points) {
  Packet packet;
  packet.frame = frame;
  packet.reference_frame = reference;
  packet.kind = frame == reference ? FrameKind::key : FrameKind::predicted;
  packet.points_in = packet.points_out = points;
  packet.payload = std::move(payload);
  return packet;
}

std::vector<std::uint8_t> with_pose(const std::vector<float>& pose, std::vector<std::uint8_t> frame) {
  ByteWriter writer;
  for (const float value : pose) writer.put(value);
  writer.put(std::span(std::as_const(frame)));
  return writer.take();
}

TEST(CraftedReels, PosesOfNanAndInfinity) {
  const SampleReel good(planes_sample(ResidualMode::stepped));
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const float value : {nan, infinity, -infinity, 2.0f, 3e38f}) {
    for (std::size_t at = 0; at < 6; ++at) {
      auto packets = good.packets;
      std::memcpy(&packets[1].payload[4 * at], &value, sizeof(value));
      const Outcome outcome = survive(reel_of(good.header, packets));
      // Only a far translation can be a pose.
      const bool possible = at >= 3 && std::isfinite(value);
      if (!possible) {
        EXPECT_EQ(outcome.errors, 1u) << value << " at " << at;
      }
      EXPECT_GE(outcome.sweeps, 5u);
    }
  }
}

TEST(CraftedReels, AbsurdRowCountsOfTinyPackets) {
  for (const int tile_size : {2, 3, 16}) {
    std::vector<Packet> packets;
    std::uint32_t frame = 0;
    for (const int rows : {1, 100, 800, kFinestRows / tile_size, 0xFFFF}) {
      for (const int first : {0, 1, 5000, 0xFFFF}) {
        for (const unsigned fill : {0x00u, 0xFFu, 0x55u}) {
          for (int copy = 0; copy < 10; ++copy, ++frame) {
            packets.push_back(crafted_packet(
                frame, frame, frame_payload(first, rows, 8, static_cast<std::uint8_t>(fill)), 1000));
          }
        }
      }
    }
    const Outcome outcome = survive(reel_of(finest_header(tile_size), packets));
    EXPECT_EQ(outcome.sweeps + outcome.errors, packets.size());
  }
}

// A few kilobytes that decode to the largest image there can be, all cells occupied: key and predicted.
TEST(CraftedReels, TheLargestImagesInTheFewestBytes) {
  const int rows = static_cast<int>(kMaxImageCells) / kFinestColumns / 2;
  const auto points = static_cast<std::uint32_t>(rows * 2 * kFinestColumns);
  for (const std::size_t bytes : {3'000u, 100'000u}) {
    std::vector<Packet> packets = {crafted_packet(0, 0, frame_payload(0, rows, bytes, 0), points)};
    for (std::uint32_t frame = 1; frame < 4; ++frame) {
      packets.push_back(crafted_packet(
          frame, 0, with_pose(std::vector<float>(6), frame_payload(0, rows, bytes, 0)), points));
    }
    const Outcome outcome = survive(reel_of(finest_header(), packets));
    EXPECT_EQ(outcome.sweeps + outcome.errors, packets.size());
  }
}

// The same with valid frames: every cell 10 m away, which a few runs of planes or none at all can say.
TEST(CraftedReels, ValidFramesOfTheMostPoints) {
  const StreamHeader header = finest_header(16);
  const auto grid = AngularGrid::create(0.0003, 0.0003);
  RangeImage image;
  image.rows = static_cast<int>(kMaxImageCells) / kFinestColumns / 16 * 16;
  image.columns = kFinestColumns;
  image.first_row = kFinestRows / 2 / 16 * 16;
  image.range_m.assign(image.index(image.rows, 0), 10.0f);
  const auto points = static_cast<std::uint32_t>(image.range_m.size());
  std::vector<Packet> packets;
  {
    const CodedFrame frame = encode_frame(*grid, image, frame_settings(header.planes), nullptr, 2);
    EXPECT_LT(frame.bytes.size(), 200'000u);
    for (const std::uint32_t number : {0u, 1u, 2u}) {
      packets.push_back(crafted_packet(number, number, frame.bytes, points));
    }
  }
  image = {};
  const Outcome outcome = survive(reel_of(header, packets));
  EXPECT_EQ(outcome.sweeps, packets.size());
}

TEST(CraftedReels, RowsBeyondTheMostCellsAreErrors) {
  const int rows = static_cast<int>(kMaxImageCells) / kFinestColumns / 2 + 1;
  const Outcome outcome =
      survive(reel_of(finest_header(), {crafted_packet(0, 0, frame_payload(0, rows, 100'000, 0), 1)}));
  EXPECT_EQ(outcome.errors, 1u);
}

TEST(CraftedReels, CountsThatClaimBillions) {
  const SampleReel good(planes_sample(ResidualMode::raw_float));
  auto packets = good.packets;
  for (Packet& packet : packets) packet.points_in = packet.points_out = 0xFFFFFFFFu, packet.non_finite = 0;
  const Outcome outcome = survive(reel_of(good.header, packets));
  EXPECT_EQ(outcome.errors, packets.size());
}

TEST(CraftedReels, SizesThatClaimMoreThanTheFile) {
  std::string bytes = SampleReel(planes_sample(ResidualMode::stepped)).bytes();
  for (const std::uint32_t size : {kMaxPayloadBytes, kMaxPayloadBytes + 1, 0xFFFFFFFFu, 0u}) {
    std::memcpy(&bytes[kStreamHeaderBytes + 4], &size, sizeof(size));
    const Outcome outcome = survive(bytes);
    EXPECT_EQ(outcome.sweeps, 0u);
    EXPECT_EQ(outcome.ending, ReelEnding::cut_off);
  }
}

}  // namespace
}  // namespace pointreel
