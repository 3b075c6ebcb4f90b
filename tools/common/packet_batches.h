// Packets of a reel in batches that decode well in parallel: whole groups, several where groups are short.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "pointreel/reel.h"

namespace pointreel {

class PacketBatches {
 public:
  explicit PacketBatches(ReelReader& reader) : reader_(reader) {}

  // The next batch, empty at the end. It starts with a key frame and holds no half group.
  std::vector<Packet> next() {
    std::vector<Packet> batch;
    if (pending_) batch.push_back(*std::exchange(pending_, std::nullopt));
    while (auto packet = reader_.read_packet()) {
      if (packet->kind == FrameKind::key && batch.size() >= kEnough) {
        pending_ = std::move(packet);
        break;
      }
      batch.push_back(*std::move(packet));
    }
    return batch;
  }

 private:
  static constexpr std::size_t kEnough = 8;
  ReelReader& reader_;
  std::optional<Packet> pending_;
};

}  // namespace pointreel
