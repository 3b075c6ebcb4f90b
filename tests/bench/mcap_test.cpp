// The MCAP files that Cloudini's converter is given and gives back.
#include "codecs/mcap.h"

#include <gtest/gtest.h>

namespace pointreel::mcap {
namespace {

constexpr std::size_t kMagic = 8;

// What a writer makes of the file of a message when it does not compress: the same records in a chunk.
Bytes chunk_of(const Bytes& file) {
  const std::span records = std::span(file).subspan(kMagic);
  Bytes chunk(
      28 + 4 +
      8);  // times, size and checksum; no compression; the size of the records, which the reader skips
  chunk.insert(chunk.end(), records.begin(), records.end());
  return chunk;
}

TEST(Mcap, FilesBeginAndEndWithTheMagic) {
  const Bytes magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
  for (const Bytes& file : {file_of_message("a/b", Bytes{1, 2, 3}), file_of_chunk(Bytes{4})}) {
    EXPECT_EQ(Bytes(file.begin(), file.begin() + kMagic), magic);
    EXPECT_EQ(Bytes(file.end() - kMagic, file.end()), magic);
  }
}

TEST(Mcap, AMessageComesBack) {
  const Bytes message = {1, 2, 3, 255};
  const auto found = message_of_chunk(chunk_of(file_of_message("sensor_msgs/msg/PointCloud2", message)));
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, message);
}

TEST(Mcap, AChunkComesBack) {
  const Bytes chunk = {9, 8, 7};
  const auto found = chunk_of_file(file_of_chunk(chunk));
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, chunk);
}

TEST(Mcap, WhatIsCutOffOrCompressedIsSaid) {
  const Bytes file = file_of_chunk(Bytes(100));
  for (std::size_t size = 0; size < kMagic + 17 + 109; ++size)
    EXPECT_FALSE(chunk_of_file(std::span(file).first(size)));
  const Bytes chunk = chunk_of(file_of_message("a/b", Bytes(10)));
  for (std::size_t size = 0; size < chunk.size() - 66; ++size)
    EXPECT_FALSE(message_of_chunk(std::span(chunk).first(size)));
  Bytes compressed = chunk;
  compressed[28] = 4;
  EXPECT_FALSE(message_of_chunk(compressed));
}

}  // namespace
}  // namespace pointreel::mcap
