// A small reel whose packets need not decode: the container does not look inside.
#pragma once

#include <cstdint>
#include <vector>

#include "support/reels.h"

namespace pointreel {

inline StreamHeader sample_header() {
  StreamHeader header;
  header.method = Method::planes;
  header.planes.grid = PlaneGrid::uniform;
  header.planes.residual_step_m = 0.2;
  return header;
}

// Frames 1 0 2, 4 3 5 in groups of three.
inline std::vector<Packet> sample_packets() {
  std::vector<Packet> packets;
  for (const std::uint32_t frame : {1u, 0u, 2u, 4u, 3u, 5u}) {
    Packet packet;
    packet.frame = frame;
    packet.group = frame / 3;
    packet.reference_frame = packet.group * 3 + 1;
    packet.kind = packet.reference_frame == frame ? FrameKind::key : FrameKind::predicted;
    packet.points_in = 100 + frame;
    packet.points_out = 90;
    packet.payload.assign(10 + 3 * frame, static_cast<std::uint8_t>(0xA0 + frame));
    packets.push_back(packet);
  }
  return packets;
}

inline void expect_first_packets(const std::vector<Packet>& read, std::size_t count) {
  const auto expected = sample_packets();
  ASSERT_EQ(read.size(), count);
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(serialize(read[i]), serialize(expected[i])) << i;
}

}  // namespace pointreel
