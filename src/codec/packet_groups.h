// Where groups begin among packets in stream order: a key frame knows nothing of what is before it.
#pragma once

#include <cstddef>
#include <span>
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
