#include "pointreel/reel.h"

#include <gtest/gtest.h>

#include <streambuf>

#include "sample_reel.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

TEST(Reel, ReadsWhatWasWritten) {
  std::istringstream stream(reel_of(sample_header(), sample_packets()));
  auto reader = ReelReader::open(stream, "drive.reel");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(serialize(reader->header()), serialize(sample_header()));
  EXPECT_EQ(reader->ending(), ReelEnding::open);
  const ReadReel read = read_rest(*reader);
  expect_first_packets(read.packets, 6);
  EXPECT_EQ(read.ending, ReelEnding::complete);
  EXPECT_FALSE(read.fault);
}

TEST(Reel, WithoutPacketsIsComplete) {
  std::istringstream stream(reel_of(sample_header(), {}));
  auto reader = ReelReader::open(stream, "empty.reel");
  ASSERT_TRUE(reader);
  const auto index = reader->index();
  ASSERT_TRUE(index);
  EXPECT_TRUE(index->entries.empty());
  EXPECT_FALSE(index->fault);
  EXPECT_EQ(read_rest(*reader).ending, ReelEnding::complete);
}

TEST(Reel, IndexFindsWhatAFrameNeeds) {
  ReelIndex index;
  index.entries = {{0, 0, 100, 10}, {1, 0, 110, 10}, {2, 1, 120, 10}, {3, 3, 130, 10},
                   {5, 4, 140, 10}, {6, 7, 150, 10}, {7, 6, 160, 10}};
  const auto frames = [&](std::uint32_t frame) {
    std::vector<std::uint32_t> needed;
    for (const ReelIndexEntry& entry : index.needed_for(frame)) needed.push_back(entry.frame);
    return needed;
  };
  EXPECT_EQ(frames(2), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(frames(3), (std::vector<std::uint32_t>{3}));
  EXPECT_TRUE(frames(5).empty());  // its reference is missing
  EXPECT_TRUE(frames(6).empty());  // a circle
  EXPECT_TRUE(frames(9).empty());
}

TEST(Reel, IndexTellsWhereEachFrameIs) {
  std::istringstream stream(reel_of(sample_header(), sample_packets()));
  auto reader = ReelReader::open(stream, "drive.reel");
  ASSERT_TRUE(reader);
  const auto index = reader->index();
  ASSERT_TRUE(index);
  EXPECT_FALSE(index->fault);
  const auto packets = sample_packets();
  const auto offsets = packet_offsets(packets);
  ASSERT_EQ(index->entries.size(), packets.size());
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(index->entries[i].frame, packets[i].frame);
    EXPECT_EQ(index->entries[i].reference_frame, packets[i].reference_frame);
    EXPECT_EQ(index->entries[i].offset, offsets[i]);
    EXPECT_EQ(index->entries[i].bytes, offsets[i + 1] - offsets[i]);
  }
  expect_first_packets(read_rest(*reader).packets, 6);
}

TEST(Reel, SeeksInAnyOrderAndAfterItsEnd) {
  std::istringstream stream(reel_of(sample_header(), sample_packets()));
  auto reader = ReelReader::open(stream, "drive.reel");
  ASSERT_TRUE(reader);
  const auto index = reader->index();
  ASSERT_TRUE(index);
  read_rest(*reader);
  for (const std::size_t i : {5u, 0u, 3u, 3u, 1u}) {
    ASSERT_TRUE(reader->seek(index->entries[i]));
    EXPECT_EQ(reader->ending(), ReelEnding::open);
    const auto packet = reader->read_packet();
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->frame, index->entries[i].frame);
  }
  ASSERT_TRUE(reader->seek(index->entries[4]));
  const ReadReel rest = read_rest(*reader);
  EXPECT_EQ(rest.packets.size(), 2u);
  EXPECT_EQ(rest.ending, ReelEnding::complete) << "reading began in the middle, nothing is missing behind it";
}

// As a pipe is: no way to seek, and short reads.
class PipeBuffer : public std::streambuf {
 public:
  explicit PipeBuffer(std::string bytes) : bytes_(std::move(bytes)) {}

 protected:
  int_type underflow() override {
    if (position_ == bytes_.size()) return traits_type::eof();
    const std::size_t count = std::min<std::size_t>(7, bytes_.size() - position_);
    setg(bytes_.data() + position_, bytes_.data() + position_, bytes_.data() + position_ + count);
    position_ += count;
    return traits_type::to_int_type(*gptr());
  }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

TEST(Reel, ReadsFromAPipe) {
  PipeBuffer pipe(reel_of(sample_header(), sample_packets()));
  std::istream stream(&pipe);
  auto reader = ReelReader::open(stream, "standard input");
  ASSERT_TRUE(reader);
  const ReadReel read = read_rest(*reader);
  expect_first_packets(read.packets, 6);
  EXPECT_EQ(read.ending, ReelEnding::complete);
}

TEST(Reel, APipeHasNoIndexAndSaysSo) {
  PipeBuffer pipe(reel_of(sample_header(), sample_packets()));
  std::istream stream(&pipe);
  auto reader = ReelReader::open(stream, "standard input");
  ASSERT_TRUE(reader);
  expect_error(reader->index(), ErrorCode::io_error, {"standard input", "cannot seek"});
  expect_error(reader->seek({0, 0, 52, 100}), ErrorCode::io_error, "cannot seek to byte 52");
}

TEST(Reel, AStreamThatIsStillWrittenGivesItsPacketsSoFar) {
  std::istringstream stream(reel_of(sample_header(), sample_packets(), false));
  auto reader = ReelReader::open(stream, "live.reel");
  ASSERT_TRUE(reader);
  const ReadReel read = read_rest(*reader);
  expect_first_packets(read.packets, 6);
  EXPECT_EQ(read.ending, ReelEnding::cut_off);
  ASSERT_TRUE(read.fault);
  EXPECT_NE(read.fault->message.find("live.reel: "), std::string::npos) << read.fault->message;
}

// A disk that is full after `room` bytes.
class FullDisk : public std::streambuf {
 public:
  explicit FullDisk(std::size_t room) : room_(room) {}

 protected:
  int_type overflow(int_type c) override { return room_-- > 0 ? c : traits_type::eof(); }

 private:
  std::size_t room_;
};

TEST(ReelWriter, SaysWhereTheDiskWasFull) {
  const auto packets = sample_packets();
  const auto offsets = packet_offsets(packets);
  FullDisk no_room(10);
  std::ostream refusing(&no_room);
  expect_error(ReelWriter::create(refusing, sample_header()), ErrorCode::io_error, "byte 0");

  FullDisk room_for_two(offsets[2] + 5);
  std::ostream stream(&room_for_two);
  auto writer = ReelWriter::create(stream, sample_header());
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->write(packets[0]));
  EXPECT_TRUE(writer->write(packets[1]));
  expect_error(writer->write(packets[2]), ErrorCode::io_error, "byte " + std::to_string(offsets[2]));
  EXPECT_EQ(writer->bytes_written(), offsets[2]);
}

}  // namespace
}  // namespace pointreel
