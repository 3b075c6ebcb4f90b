#include "entropy/wide_integer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "entropy/plain_bits.h"

namespace pointreel {
namespace {

RC_GTEST_PROP(AdaptiveWideInteger, BringsBackAnyValues, ()) {
  auto values = *rc::gen::container<std::vector<std::uint64_t>>(rc::gen::arbitrary<std::uint64_t>());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] >>= (7 * i) % 65 == 64 ? 63 : (7 * i) % 65;
  values.push_back(~std::uint64_t{0});
  const int modelled_bits = *rc::gen::inRange(0, 11);
  BitEncoder encoder;
  AdaptiveWideInteger model(modelled_bits);
  for (const std::uint64_t value : values) {
    RC_ASSERT(model.code(encoder, value) == value);
    RC_ASSERT(code_plain_bits(encoder, value, 64) == value);
  }
  const auto bytes = encoder.finish();
  BitDecoder decoder(bytes);
  AdaptiveWideInteger mirror(modelled_bits);
  for (const std::uint64_t value : values) {
    RC_ASSERT(mirror.code(decoder, 0) == value);
    RC_ASSERT(code_plain_bits(decoder, 0, 64) == value);
  }
  RC_ASSERT(!decoder.overran());
}

TEST(AdaptiveWideInteger, LearnsAFewLargeNumbers) {
  std::mt19937 random(3);
  BitEncoder encoder;
  AdaptiveWideInteger model(10);
  for (int i = 0; i < 10'000; ++i) model.code(encoder, 1392 + random() % 4);
  EXPECT_LT(8.0 * static_cast<double>(encoder.finish().size()) / 10'000, 2.2);
}

TEST(Zigzag, PutsSmallMagnitudesFirst) {
  EXPECT_EQ(zigzag(0), 0u);
  EXPECT_EQ(zigzag(~std::uint64_t{0}), 1u);
  EXPECT_EQ(zigzag(1), 2u);
  for (const std::uint64_t value :
       {std::uint64_t{0}, std::uint64_t{5}, ~std::uint64_t{6}, std::uint64_t{1} << 63}) {
    EXPECT_EQ(unzigzag(zigzag(value)), value);
  }
}

}  // namespace
}  // namespace pointreel
