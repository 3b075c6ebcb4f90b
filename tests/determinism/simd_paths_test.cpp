// Every instruction set encodes to the same bytes. (That all decode to the same bits is decode_paths' part.)
#include "support/simd_paths.h"

#include <gtest/gtest.h>

#include "pointreel/codec.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

std::vector<std::uint8_t> encoded(const std::vector<SimulatedSweep>& sweeps, double max_error_m,
                                  Effort effort) {
  EncoderOptions options;
  options.mixture.max_error_m = max_error_m;
  options.mixture.effort = effort;
  auto encoder = Encoder::create(options);
  std::vector<std::uint8_t> bytes;
  for (const SimulatedSweep& sweep : sweeps) {
    const auto packets = encoder->encode(sweep.cloud);
    for (const Packet& packet : *packets) {
      const auto serialized = serialize(packet);
      bytes.insert(bytes.end(), serialized.begin(), serialized.end());
    }
  }
  return bytes;
}

TEST(SimdPaths, EncodeToTheSameBytes) {
  const auto sweeps = simulated_drive(2);
  for (const Effort effort : {Effort::fast, Effort::balanced, Effort::max}) {
    for (const double max_error_m : {0.02, 0.001}) {
      std::vector<std::uint8_t> first;
      for_each_simd_path([&](const char* path) {
        const auto bytes = encoded(sweeps, max_error_m, effort);
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first) << path << ", " << max_error_m << " m, effort " << static_cast<int>(effort);
      });
      EXPECT_FALSE(first.empty());
    }
  }
}

}  // namespace
}  // namespace pointreel
