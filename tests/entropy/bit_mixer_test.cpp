#include "entropy/bit_mixer.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace pointreel {
namespace {

TEST(BitMixer, StretchInvertsSquashWithinItsStep) {
  for (Stretch s = -kMaxStretch; s <= kMaxStretch; ++s) {
    const Stretch back = CountedBit(squash(s), 0).stretch();
    const double p = squash(s) / 65536.0;
    // One table entry is 16 / 65536 in p.
    EXPECT_LE(std::abs(back - s), 256 * 16 / 65536.0 / (p * (1 - p)) + 2) << s;
  }
  EXPECT_EQ(squash(0), 32768u);
}

TEST(BitMixer, PinsItsTables) {
  // Tables decide probabilities: a compiler that builds others would break every stream.
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < bit_mixer_detail::kSquash.size(); ++i)
    sum = sum * 31 + bit_mixer_detail::kSquash[i];
  for (const std::int16_t s : bit_mixer_detail::kStretch)
    sum = sum * 31 + static_cast<std::uint64_t>(s + 4096);
  EXPECT_EQ(sum, 16644118816167624564u);
}

TEST(CountedBit, IsTheMeanOfTheBitsSeen) {
  CountedBit bit;
  for (int i = 0; i < 300; ++i) bit.update(i % 3 == 0);
  EXPECT_NEAR(bit.p_one() / 65536.0, 1 / 3.0, 0.01);
  EXPECT_EQ(bit.count(), 300u);
  for (int i = 0; i < 10'000; ++i) bit.update(true);
  EXPECT_EQ(bit.count(), CountedBit::kMaxCount);
  EXPECT_GT(bit.p_one(), 60000u);
}

TEST(BitMixer, LearnsWhichInputToTrust) {
  BitMixer<2> mixer;
  Probability16 p_one = 32768;
  for (int i = 0; i < 10'000; ++i) {
    const bool bit = i % 7 < 3;
    const BitMixer<2>::Inputs inputs = {bit ? 300 : -300, i % 2 == 0 ? 300 : -300};
    p_one = mixer.p_one(inputs);
    mixer.update(inputs, p_one, bit);
    if (i > 9900) {
      EXPECT_TRUE(bit ? p_one > 50000 : p_one < 15500) << i;
    }
  }
  EXPECT_GT(mixer.weight(0), 4 * std::abs(mixer.weight(1)));
}

TEST(BitMixer, StaysWithinTheCodersLimitsWhenItsInputsAreAlwaysWrong) {
  BitMixer<2> mixer;
  mixer.set_weight(0, BitMixer<2>::kOne);
  for (int i = 0; i < 200'000; ++i) {
    const BitMixer<2>::Inputs inputs = {kMaxStretch, -kMaxStretch};
    const Probability16 p_one = mixer.p_one(inputs);
    ASSERT_GE(p_one, kMinProbability);
    ASSERT_LE(p_one, 65536 - kMinProbability);
    mixer.update(inputs, p_one, p_one < 32768);
  }
}

}  // namespace
}  // namespace pointreel
