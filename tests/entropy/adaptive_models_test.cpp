#include "entropy/adaptive_models.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>

namespace pointreel {
namespace {

constexpr std::int32_t kLargest = 1 << 29;  // what plane levels and range residuals can reach

std::vector<std::uint8_t> encode_values(const std::vector<std::int32_t>& values) {
  BitEncoder coder;
  AdaptiveInteger model;
  for (const std::int32_t value : values) model.code(coder, value);
  return coder.finish();
}

std::vector<std::int32_t> decode_values(const std::vector<std::uint8_t>& bytes, std::size_t count) {
  BitDecoder coder(bytes);
  AdaptiveInteger model;
  std::vector<std::int32_t> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(model.code(coder, 0));
  EXPECT_FALSE(coder.overran());
  return values;
}

TEST(AdaptiveInteger, BringsBackEverySmallValueAndTheBordersOfItsCodes) {
  std::vector<std::int32_t> values;
  for (std::int32_t value = -5000; value <= 5000; ++value) values.push_back(value);
  for (std::int32_t power = 1; power <= kLargest; power *= 2) {
    for (const std::int32_t offset : {-1, 0, 1, 11, 12, 13, 14}) {
      for (const std::int32_t value : {power + offset, -power - offset}) {
        if (std::abs(value) <= kLargest) values.push_back(value);
      }
    }
  }
  EXPECT_EQ(decode_values(encode_values(values), values.size()), values);
}

RC_GTEST_PROP(AdaptiveInteger, BringsBackAnyValues, ()) {
  const auto values = *rc::gen::container<std::vector<std::int32_t>>(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int32_t>(-kLargest, kLargest + 1)));
  RC_ASSERT(decode_values(encode_values(values), values.size()) == values);
}

TEST(AdaptiveInteger, AnyBytesGiveValuesWithinInt32) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::uint8_t> bytes(100);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(trial == 0 ? 0 : trial == 1 ? 0xFF : random());
    BitDecoder coder(bytes);
    AdaptiveInteger model;
    // The undefined behaviour sanitizer watches the arithmetic; here: the limit that callers rely on.
    for (int i = 0; i < 100; ++i) EXPECT_LT(std::abs(model.code(coder, 0)), (1 << 30) + 16);
  }
}

double entropy_bits(const std::vector<double>& probabilities) {
  double bits = 0;
  for (const double p : probabilities) bits -= p * std::log2(p);
  return bits;
}

TEST(AdaptiveBit, CodesASkewedSourceNearItsEntropy) {
  constexpr int kCount = 100'000;
  for (const double share : {0.01, 0.1, 0.5, 0.97}) {
    std::mt19937 random(5);
    std::bernoulli_distribution source(share);
    BitEncoder coder;
    AdaptiveBit model;
    for (int i = 0; i < kCount; ++i) coder.code(model, source(random));
    const double bits = 8.0 * static_cast<double>(coder.finish().size()) / kCount;
    const double entropy = entropy_bits({share, 1 - share});
    EXPECT_LT(bits, entropy + 0.02) << "share of ones " << share;
    EXPECT_GT(bits, entropy - 0.01) << "share of ones " << share;
  }
}

TEST(AdaptiveInteger, CodesAGeometricSourceNearItsEntropy) {
  constexpr int kCount = 50'000;
  constexpr double kStop = 0.6;
  std::mt19937 random(9);
  std::geometric_distribution<std::int32_t> magnitude(kStop);
  std::vector<std::int32_t> values;
  for (int i = 0; i < kCount; ++i) {
    const std::int32_t size = magnitude(random);
    values.push_back(random() % 2 ? size : -size);
  }
  // A magnitude, and a sign wherever it is not zero.
  const double entropy = entropy_bits({kStop, 1 - kStop}) / kStop + (1 - kStop);
  const double bits = 8.0 * static_cast<double>(encode_values(values).size()) / kCount;
  EXPECT_LT(bits, 1.03 * entropy);
  EXPECT_GT(bits, 0.98 * entropy);
}

TEST(AdaptiveByte, BringsBackAllBytesAndShortensSkewedOnes) {
  std::mt19937 random(13);
  std::vector<std::uint8_t> bytes;
  for (int byte = 0; byte < 256; ++byte) bytes.push_back(static_cast<std::uint8_t>(byte));
  for (int i = 0; i < 20'000; ++i) bytes.push_back(random() % 8 ? 'a' : static_cast<std::uint8_t>(random()));

  BitEncoder encoder;
  AdaptiveByte encoder_model;
  for (const std::uint8_t byte : bytes) encoder_model.code(encoder, byte);
  const auto coded = encoder.finish();
  // One in eight is any byte: H(1/8) + 8/8 bits, about 1.55 of 8.
  EXPECT_LT(8.0 * static_cast<double>(coded.size()) / static_cast<double>(bytes.size()), 1.75);

  BitDecoder decoder(coded);
  AdaptiveByte decoder_model;
  for (const std::uint8_t byte : bytes) ASSERT_EQ(decoder_model.code(decoder, 0), byte);
  EXPECT_FALSE(decoder.overran());
}

TEST(BitCoder, EncoderReturnsTheBitsThatTheDecoderReads) {
  BitEncoder encoder;
  AdaptiveBit model;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(encoder.code(model, i % 3 == 0), i % 3 == 0);
    EXPECT_EQ(encoder.code_even(i % 2 == 0), i % 2 == 0);
  }
  const auto bytes = encoder.finish();
  BitDecoder decoder(bytes);
  AdaptiveBit mirror;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(decoder.code(mirror), i % 3 == 0);
    EXPECT_EQ(decoder.code_even(), i % 2 == 0);
  }
}

}  // namespace
}  // namespace pointreel
