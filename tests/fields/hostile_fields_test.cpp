// Damaged bytes must give an Error or some values, quickly and without much memory.
#include <gtest/gtest.h>

#include "fields/field_samples.h"

namespace pointreel {
namespace {

FieldValues sample(unsigned kind, const SampleGrid& grid) {
  std::mt19937_64 random(kind);
  std::vector<float> floats;
  std::vector<double> doubles;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    floats.push_back(i % 60 == 1 ? any_bits<float>(random) : static_cast<float>(random() % 90) / 100);
    doubles.push_back(kind == 2 ? any_bits<double>(random) : 1e9 + static_cast<double>(i / 20));
  }
  return kind == 0 ? FieldValues{floats} : FieldValues{doubles};
}

void expect_survival(std::span<const std::uint8_t> bytes, const PointLayout& layout, std::mt19937& random) {
  FieldMemory memory;
  for (int sweep = 0; sweep < 2; ++sweep) {
    const std::size_t type = random() % 12;
    const auto decoded = decode_field(bytes, type, layout, memory);
    if (!decoded) {
      EXPECT_FALSE(decoded.error().message.empty());
      return;
    }
    EXPECT_EQ(decoded->index(), type);
    std::visit([&](const auto& values) { EXPECT_EQ(values.size(), layout.size()); }, *decoded);
  }
}

TEST(HostileFields, SurviveDamage) {
  const SampleGrid grid(8, 60);
  const PointLayout layout = grid.layout();
  std::mt19937 random(17);
  for (const unsigned kind : {0u, 1u, 2u}) {
    FieldMemory memory;
    const auto bytes = encode_field(sample(kind, grid), 0, layout, memory);
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 50) {
      expect_survival(std::span(bytes).first(length), layout, random);
    }
    for (int trial = 0; trial < 300; ++trial) {
      auto damaged = bytes;
      // Mostly where the tables are.
      const std::size_t within = trial % 2 == 0 ? std::min<std::size_t>(40, damaged.size()) : damaged.size();
      damaged[random() % within] ^= static_cast<std::uint8_t>(1u << random() % 8);
      expect_survival(damaged, layout, random);
    }
  }
}

TEST(HostileFields, SurviveNoise) {
  const SampleGrid grid(8, 60);
  const PointLayout layout = grid.layout();
  std::mt19937 random(19);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<std::uint8_t> noise(random() % 400);
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(trial == 0 ? 0xFF : random());
    expect_survival(noise, layout, random);
  }
}

TEST(HostileFields, CutBytesAreTruncated) {
  const SampleGrid grid(8, 60);
  const PointLayout layout = grid.layout();
  FieldMemory encoder, decoder;
  const FieldValues values = sample(2, grid);
  const auto bytes = encode_field(values, 0, layout, encoder);
  const auto decoded =
      decode_field(std::span(bytes).first(bytes.size() / 2), values.index(), layout, decoder);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, ErrorCode::truncated);
}

}  // namespace
}  // namespace pointreel
