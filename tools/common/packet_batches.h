// Packets of a reel in batches that decode well in parallel: whole groups, several where groups are short.
// One by one where they come live, as the sender may not have the next one yet, and for one thread, which
// gains nothing by more: the memory of one sweep serves all.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pointreel/reel.h"

namespace pointreel {

class PacketBatches {
 public:
  // `threads`: that decode, so many groups side by side.
  PacketBatches(ReelReader& reader, int threads, bool live = false)
      : reader_(reader),
        threads_(threads),
        one_by_one_(live || (threads == 1 && reader.header().on_sensor_grid())) {}

  bool one_by_one() const { return one_by_one_; }

  // The next batch, empty at the end.
  std::vector<Packet> next() {
    if (!one_by_one_) return next_groups();
    auto packet = reader_.read_packet();
    return packet ? std::vector<Packet>{*std::move(packet)} : std::vector<Packet>();
  }

  // The same in whole groups: the first is a key frame and no group is divided, unless that would be too much
  // to have in memory at once; a Decoder takes the rest of a group in another batch as well.
  std::vector<Packet> next_groups() {
    std::vector<Packet> batch;
    std::uint64_t points = pending_ ? pending_->points_out : 0;
    int keys = pending_ ? 1 : 0;
    if (pending_) batch.push_back(*std::exchange(pending_, std::nullopt));
    while (points < kMostPoints && batch.size() < kMostPackets) {
      auto packet = reader_.read_packet();
      if (!packet) break;
      if (packet->kind == FrameKind::key) {
        if (batch.size() >= kEnough && keys >= threads_) {
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

 private:
  static constexpr std::size_t kEnough = 8;
  static constexpr std::size_t kMostPackets = 255 + kEnough;  // a whole group always fits
  static constexpr std::uint64_t kMostPoints = 20'000'000;    // 240 MB of decoded points
  ReelReader& reader_;
  int threads_;
  bool one_by_one_;
  std::optional<Packet> pending_;
};

}  // namespace pointreel
