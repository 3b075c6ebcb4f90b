// ReelReader::resume: what is whole behind damage is read, in streams that cannot seek, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "codec/wire.h"
#include "sample_reel.h"

namespace pointreel {
namespace {

class ResumedReel : public testing::Test {
 protected:
  // Serialized packets, read from front to end, past every damage.
  static std::vector<std::vector<std::uint8_t>> read_past_damage(const std::string& bytes, int& faults) {
    std::istringstream stream(bytes);
    auto reader = ReelReader::open(stream, "drive.reel");
    EXPECT_TRUE(reader);
    std::vector<std::vector<std::uint8_t>> packets;
    faults = 0;
    do {
      while (const auto packet = reader->read_packet()) packets.push_back(serialize(*packet));
      faults += reader->fault().has_value();
    } while (reader->resume());
    return packets;
  }

  // All but those that lie in [begin, end) in part.
  std::vector<std::vector<std::uint8_t>> packets_without(std::size_t begin, std::size_t end) const {
    std::vector<std::vector<std::uint8_t>> packets;
    for (std::size_t i = 0; i + 1 < offsets_.size(); ++i) {
      if (end <= offsets_[i] || begin >= offsets_[i + 1]) packets.push_back(serialize(sample_packets()[i]));
    }
    return packets;
  }

  const std::vector<std::size_t> offsets_ = packet_offsets(sample_packets());
  const std::string whole_ = reel_of(sample_header(), sample_packets());
};

TEST_F(ResumedReel, AWholeReelNeedsNoResuming) {
  int faults = 0;
  EXPECT_EQ(read_past_damage(whole_, faults), packets_without(0, 0));
  EXPECT_EQ(faults, 0);
}

TEST_F(ResumedReel, AChangedByteCostsItsPacketOnly) {
  for (std::size_t at = kStreamHeaderBytes; at < offsets_.back(); ++at) {
    for (const char change : {'\x01', '\x40'}) {
      std::string bytes = whole_;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      int faults = 0;
      EXPECT_EQ(read_past_damage(bytes, faults), packets_without(at, at + 1)) << "byte " << at;
      EXPECT_EQ(faults, 1);
    }
  }
}

TEST_F(ResumedReel, MissingBytesCostTheirPacketsOnly) {
  for (const std::size_t count : {1u, 7u, 60u}) {
    for (std::size_t at = kStreamHeaderBytes; at + count < offsets_.back(); ++at) {
      std::string bytes = whole_;
      bytes.erase(at, count);
      int faults = 0;
      EXPECT_EQ(read_past_damage(bytes, faults), packets_without(at, at + count))
          << count << " bytes at " << at;
      EXPECT_GT(faults, 0);
    }
  }
}

TEST_F(ResumedReel, SyncWordsWithoutPacketsTakeNoTime) {
  const auto start = std::chrono::steady_clock::now();
  for (const std::uint32_t claim : {0u, 37u, 500'000u, kMaxPayloadBytes}) {
    std::string bytes = whole_;
    for (int i = 0; i < 500'000; ++i) {
      bytes.append(reinterpret_cast<const char*>(&kPacketSync), 4)
          .append(reinterpret_cast<const char*>(&claim), 4);
    }
    bytes.erase(offsets_.back(), whole_.size() - offsets_.back());
    int faults = 0;
    EXPECT_EQ(read_past_damage(bytes, faults), packets_without(0, 0));
    EXPECT_EQ(faults, 1);
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 30);
}

}  // namespace
}  // namespace pointreel
