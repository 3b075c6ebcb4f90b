// Packets of a reel in batches that decode well in parallel: whole groups, several where groups are short.
// For one thread, which gains nothing by that, one by one, so that the memory of one sweep serves all.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pointreel/reel.h"

namespace pointreel {

class PacketBatches {
 public:
  // `groups`: as many as can be decoded side by side.
  PacketBatches(ReelReader& reader, int groups) : reader_(reader), groups_(groups) {}

  // The next batch, empty at the end.
  std::vector<Packet> next() {
    return groups_ == 1 && reader_.header().on_sensor_grid() ? next_packet() : next_groups();
  }

 private:
  std::vector<Packet> next_packet() {
    auto packet = reader_.read_packet();
    return packet ? std::vector<Packet>{*std::move(packet)} : std::vector<Packet>();
  }

  // The first is a key frame and no group is divided, unless that would be too much to have in memory at
  // once; a Decoder takes the rest of a group in another batch as well.
  std::vector<Packet> next_groups() {
    std::vector<Packet> batch;
    std::uint64_t points = pending_ ? pending_->points_out : 0;
    int keys = pending_ ? 1 : 0;
    if (pending_) batch.push_back(*std::exchange(pending_, std::nullopt));
    while (points < kMostPoints && batch.size() < kMostPackets) {
      auto packet = reader_.read_packet();
      if (!packet) break;
      if (packet->kind == FrameKind::key) {
        if (batch.size() >= kEnough && keys >= groups_) {
          pending_ = std::move(packet);
          break;
        }
        ++keys;
      }
      points += packet->points_out;
      batch.push_back(*std::move(packet));
    }
    return batch;
  }

  static constexpr std::size_t kEnough = 8;
  static constexpr std::size_t kMostPackets = 255 + kEnough;  // a whole group always fits
  static constexpr std::uint64_t kMostPoints = 20'000'000;    // 240 MB of decoded points
  ReelReader& reader_;
  int groups_;
  std::optional<Packet> pending_;
};

}  // namespace pointreel
