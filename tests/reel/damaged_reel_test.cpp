// Reels that are cut off, changed or no reels: what is whole before the damage is read, and the damage is
// told.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "reel/reel_layout.h"
#include "sample_reel.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

class DamagedReel : public testing::Test {
 protected:
  // Reads from front to end; `header_bad` where the header itself is gone.
  static ReadReel read(const std::string& bytes) {
    std::istringstream stream(bytes);
    auto reader = ReelReader::open(stream, "drive.reel");
    EXPECT_TRUE(reader);
    return reader ? read_rest(*reader) : ReadReel{};
  }

  static ReelIndex index_of(const std::string& bytes) {
    std::istringstream stream(bytes);
    auto reader = ReelReader::open(stream, "drive.reel");
    EXPECT_TRUE(reader);
    auto index = reader->index();
    EXPECT_TRUE(index);
    EXPECT_EQ(reader->ending(), ReelEnding::open);
    return index ? *std::move(index) : ReelIndex{};
  }

  std::size_t whole_packets_before(std::size_t length) const {
    return static_cast<std::size_t>(
        std::count_if(offsets_.begin() + 1, offsets_.end(), [&](std::size_t end) { return end <= length; }));
  }

  const std::vector<std::size_t> offsets_ = packet_offsets(sample_packets());
  const std::string whole_ = reel_of(sample_header(), sample_packets());
};

TEST_F(DamagedReel, CutAnywhereGivesEveryWholePacketBeforeTheCut) {
  for (std::size_t length = 0; length < whole_.size(); ++length) {
    SCOPED_TRACE("cut to " + std::to_string(length) + " bytes");
    const std::string cut = whole_.substr(0, length);
    if (length < kStreamHeaderBytes) {
      std::istringstream stream(cut);
      expect_error(ReelReader::open(stream, "drive.reel"), ErrorCode::truncated, {"drive.reel: ", "byte"});
      continue;
    }
    const ReadReel cut_reel = read(cut);
    expect_first_packets(cut_reel.packets, whole_packets_before(length));
    EXPECT_EQ(cut_reel.ending, ReelEnding::cut_off);
    ASSERT_TRUE(cut_reel.fault);
    EXPECT_EQ(cut_reel.fault->code, ErrorCode::truncated);
    EXPECT_EQ(cut_reel.fault->message.rfind("drive.reel: ", 0), 0u) << cut_reel.fault->message;

    const ReelIndex index = index_of(cut);
    EXPECT_EQ(index.entries.size(), whole_packets_before(length));
    EXPECT_TRUE(index.fault);
  }
}

TEST_F(DamagedReel, AChangedByteOfAPacketEndsTheReelThere) {
  for (std::size_t at = kStreamHeaderBytes; at < offsets_.back(); ++at) {
    std::string bytes = whole_;
    bytes[at] ^= 0x40;
    const ReadReel damaged = read(bytes);
    expect_first_packets(damaged.packets, whole_packets_before(at));
    EXPECT_EQ(damaged.ending, ReelEnding::cut_off);
    ASSERT_TRUE(damaged.fault);
    const auto start = *std::prev(std::upper_bound(offsets_.begin(), offsets_.end(), at));
    EXPECT_NE(damaged.fault->message.find("packet at byte " + std::to_string(start)), std::string::npos)
        << damaged.fault->message;
    // The index still knows the others.
    EXPECT_EQ(index_of(bytes).entries.size(), 6u);
  }
}

TEST_F(DamagedReel, PacketsAfterADamagedOneCanBeReachedByTheIndex) {
  std::string bytes = whole_;
  bytes[offsets_[2] + 20] ^= 1;
  std::istringstream stream(bytes);
  auto reader = ReelReader::open(stream, "drive.reel");
  const auto index = reader->index();
  ASSERT_TRUE(index);
  for (std::size_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(reader->seek(index->entries[i]));
    EXPECT_EQ(reader->read_packet().has_value(), i != 2) << i;
  }
}

TEST_F(DamagedReel, AChangedByteOfTheIndexIsToldAndCostsNoPacket) {
  for (std::size_t at = offsets_.back(); at < whole_.size(); ++at) {
    SCOPED_TRACE("byte " + std::to_string(at) + " of " + std::to_string(whole_.size()));
    std::string bytes = whole_;
    bytes[at] ^= 0x04;
    const ReelIndex index = index_of(bytes);
    ASSERT_TRUE(index.fault);
    ASSERT_EQ(index.entries.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(index.entries[i].offset, offsets_[i]);
    const ReadReel read_reel = read(bytes);
    expect_first_packets(read_reel.packets, 6);
    EXPECT_EQ(read_reel.ending, ReelEnding::cut_off) << "not as finish() leaves it";
  }
}

TEST_F(DamagedReel, APacketThatWasTakenOutIsMissed) {
  for (std::size_t i = 0; i < 6; ++i) {
    std::string bytes = whole_;
    bytes.erase(offsets_[i], offsets_[i + 1] - offsets_[i]);
    const ReadReel read_reel = read(bytes);
    EXPECT_EQ(read_reel.packets.size(), 5u);
    EXPECT_EQ(read_reel.ending, ReelEnding::cut_off);
    ASSERT_TRUE(read_reel.fault);
    const ReelIndex index = index_of(bytes);
    EXPECT_TRUE(index.fault);
    EXPECT_EQ(index.entries.size(), 5u);
  }
}

TEST_F(DamagedReel, AnIndexThatLiesIsNotBelieved) {
  // Entry sizes changed with the checksum made to fit: the sum of sizes gives it away.
  for (const int change : {1, -1, 1'000'000'000}) {
    std::string bytes = whole_;
    const std::size_t index_end = bytes.size() - kFooterBytes;
    std::vector<std::uint8_t> index(bytes.begin() + static_cast<std::ptrdiff_t>(offsets_.back()),
                                    bytes.begin() + static_cast<std::ptrdiff_t>(index_end));
    std::uint32_t size = 0;
    std::memcpy(&size, &index[kIndexHeaderBytes + 8], sizeof(size));
    size += static_cast<std::uint32_t>(change);
    std::memcpy(&index[kIndexHeaderBytes + 8], &size, sizeof(size));
    refresh_checksum(index);
    std::copy(index.begin(), index.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offsets_.back()));
    const ReelIndex walked = index_of(bytes);
    EXPECT_TRUE(walked.fault);
    EXPECT_EQ(walked.entries.size(), 6u);
    EXPECT_EQ(walked.entries[1].offset, offsets_[1]);
  }
}

TEST_F(DamagedReel, GarbageIsNoReel) {
  std::mt19937 random(1);
  for (const std::size_t size : {0u, 1u, 51u, 52u, 53u, 4096u}) {
    std::string bytes(size, '\0');
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<char>(random()); });
    std::istringstream stream(bytes);
    const auto reader = ReelReader::open(stream, "garbage.reel");
    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().message.rfind("garbage.reel: ", 0), 0u);
  }
  std::string text = "not a reel but some lines of text, and more than fifty-two of its letters";
  std::istringstream stream(text);
  expect_error(ReelReader::open(stream, "notes.txt"), ErrorCode::corrupt, {"notes.txt: ", "no magic bytes"});
}

TEST_F(DamagedReel, AHugeClaimedPacketTakesNoMemory) {
  std::string bytes = whole_.substr(0, offsets_[1]);
  const std::uint32_t sync = kPacketSync, claim = kMaxPayloadBytes;
  bytes.append(reinterpret_cast<const char*>(&sync), 4).append(reinterpret_cast<const char*>(&claim), 4);
  const ReadReel read_reel = read(bytes);
  expect_first_packets(read_reel.packets, 1);
  EXPECT_EQ(read_reel.fault->code, ErrorCode::truncated);
}

}  // namespace
}  // namespace pointreel
