// Reels in memory: made, read to their end, and damaged.
#pragma once

#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstring>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "codec/wire.h"
#include "pointreel/reel.h"

namespace pointreel {

inline std::string reel_of(const StreamHeader& header, const std::vector<Packet>& packets,
                           bool finished = true) {
  std::ostringstream stream;
  auto writer = ReelWriter::create(stream, header);
  EXPECT_TRUE(writer);
  for (const Packet& packet : packets) EXPECT_TRUE(writer->write(packet));
  if (finished) {
    EXPECT_TRUE(writer->finish());
  }
  EXPECT_EQ(writer->bytes_written(), stream.str().size());
  return stream.str();
}

// Where each packet starts, and behind the last where the index does.
inline std::vector<std::size_t> packet_offsets(const std::vector<Packet>& packets) {
  std::vector<std::size_t> offsets = {kStreamHeaderBytes};
  for (const Packet& packet : packets) offsets.push_back(offsets.back() + serialize(packet).size());
  return offsets;
}

struct ReadReel {
  std::vector<Packet> packets;
  ReelEnding ending = ReelEnding::open;
  std::optional<Error> fault;
};

// From the reader's position to the end.
inline ReadReel read_rest(ReelReader& reader) {
  ReadReel read;
  while (auto packet = reader.read_packet()) read.packets.push_back(*std::move(packet));
  read.ending = reader.ending();
  read.fault = reader.fault();
  EXPECT_FALSE(reader.read_packet()) << "an ended reel stays ended";
  return read;
}

// The packet's own checksum again, after its bytes were changed.
inline void refresh_checksum(std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < kChecksumBytes) return;
  const std::size_t covered = bytes.size() - kChecksumBytes;
  const std::uint32_t sum = XXH32(bytes.data(), covered, 0);
  std::memcpy(bytes.data() + covered, &sum, sizeof(sum));
}

}  // namespace pointreel
