// Streams of every format version decode to the points and fields they always did, bit for bit, whatever the
// compiler, the processor and the optimiser. Each NAME.reel has its NAME.txt: its lines of sweep_digest.h.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "support/sweep_digest.h"

namespace pointreel {
namespace {

std::string text_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, DecodesToTheSameBits) {
  const std::string stem = std::string(POINTREEL_GOLDEN) + "/" + GetParam();
  std::istringstream stream(text_of_file(stem + ".reel"));
  const auto decoded = digest_of_reel(stream, GetParam());
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(*decoded, text_of_file(stem + ".txt"));
}

INSTANTIATE_TEST_SUITE_P(Version1, Golden,
                         testing::Values("planes_v1_stream", "planes_v1_raw", "mixture_v1_firing_order",
                                         "mixture_v1_compensated", "mixture_v1_scattered", "mixture_v1_max",
                                         "planes_v1_sensor"));

}  // namespace
}  // namespace pointreel
