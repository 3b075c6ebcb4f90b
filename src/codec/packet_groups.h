// Where groups begin among packets in stream order: a key frame knows nothing of what is before it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pointreel/codec.h"

namespace pointreel {

// How many packets to take so that there is a key frame for each thread, no more: what is decoded of each
// group is held in memory.
inline std::size_t packets_of_groups(std::span<const Packet> packets, int threads) {
  int keys = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (packets[i].kind == FrameKind::key && ++keys > threads) return i;
  }
  return packets.size();
}

// Decodes by decode_groups(packets), groups for as many threads at a time.
template <class DecodeGroups>
std::vector<Result<DecodedSweep>> decode_by_groups(std::span<const Packet> packets, int threads,
                                                   const DecodeGroups& decode_groups) {
  std::vector<Result<DecodedSweep>> sweeps;
  sweeps.reserve(packets.size());
  while (sweeps.size() < packets.size()) {
    const std::span<const Packet> left = packets.subspan(sweeps.size());
    for (auto& sweep : decode_groups(left.first(packets_of_groups(left, threads))))
      sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

// What went wrong with a packet, with the frame's name.
inline Error in_frame(const Packet& packet, const Error& error) {
  return {error.code, "frame " + std::to_string(packet.frame) + ": " + error.message};
}

// The first packet of each group, and the number of packets. The first group may have begun before them.
inline std::vector<std::size_t> firsts_of_groups(std::span<const Packet> packets) {
  std::vector<std::size_t> firsts;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (i == 0 || packets[i].kind == FrameKind::key) firsts.push_back(i);
  }
  firsts.push_back(packets.size());
  return firsts;
}

}  // namespace pointreel
