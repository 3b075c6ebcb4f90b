// Streams of every format version decode to the points they always did, bit for bit, whatever the compiler,
// the processor and the optimiser. Each NAME.reel has its NAME.txt: "frame points XXH64 of the positions" a
// line.
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include "pointreel/reel.h"

namespace pointreel {
namespace {

std::string text_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string line_of(const DecodedSweep& sweep) {
  const auto& positions = sweep.cloud.positions;
  char line[64];
  std::snprintf(
      line, sizeof(line), "%u %zu %016llx\n", sweep.frame, positions.size(),
      static_cast<unsigned long long>(XXH64(positions.data(), positions.size() * sizeof(Point3f), 0)));
  return line;
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, DecodesToTheSameBits) {
  const std::string stem = std::string(POINTREEL_GOLDEN) + "/" + GetParam();
  std::istringstream stream(text_of_file(stem + ".reel"));
  auto reader = ReelReader::open(stream, GetParam());
  ASSERT_TRUE(reader) << reader.error().message;
  auto decoder = Decoder::create(reader->header());
  ASSERT_TRUE(decoder);
  std::string decoded;
  while (const auto packet = reader->read_packet()) {
    for (const auto& sweep : decoder->decode({&*packet, 1})) {
      ASSERT_TRUE(sweep) << sweep.error().message;
      decoded += line_of(*sweep);
    }
  }
  EXPECT_EQ(reader->ending(), ReelEnding::complete);
  EXPECT_EQ(decoded, text_of_file(stem + ".txt"));
}

INSTANTIATE_TEST_SUITE_P(Version1, Golden, testing::Values("planes_v1_stream", "planes_v1_raw"));

}  // namespace
}  // namespace pointreel
