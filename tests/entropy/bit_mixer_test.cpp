#include "entropy/bit_mixer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "entropy/adaptive_models.h"

namespace pointreel {
namespace {

TEST(BitMixer, SquashIsTheLogisticFunction) {
  for (Stretch s = -kMaxStretch; s <= kMaxStretch; ++s)
    EXPECT_NEAR(squash(s), 65536 / (1 + std::exp(-s / 256.0)), 0.51) << s;
}

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

TEST(CountedBit, StaysAProbability) {
  for (const bool always : {false, true}) {
    CountedBit bit;
    for (int i = 0; i < 100'000; ++i) bit.update<30>(always);
    EXPECT_EQ(bit.count(), 30u);
    EXPECT_LT(bit.p_one(), 65536u);
    EXPECT_NEAR(bit.p_one(), always ? 65535 : 0, 10);
    EXPECT_EQ(bit.stretch(), stretch(bit.p_one()));
  }
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

// Two contexts, each of which sees one half of what decides the bit, and one that sees noise.
TEST(BitMixer, CodesCloseToTheEntropyOfWhatItsInputsKnow) {
  constexpr std::size_t kCount = 50'000;
  std::mt19937 random(1);
  std::vector<std::size_t> first, second;
  std::vector<bool> bits;
  double entropy = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    first.push_back(random() % 8);
    second.push_back(random() % 8);
    const double log_odds =
        0.8 * (static_cast<double>(first[i]) - 3.5) - 0.6 * (static_cast<double>(second[i]) - 3.5);
    const double p = 1 / (1 + std::exp(-log_odds));
    bits.push_back(std::uniform_real_distribution(0.0, 1.0)(random) < p);
    entropy -= p * std::log2(p) + (1 - p) * std::log2(1 - p);
  }
  const auto code_all = [&](auto& coder) {
    std::array<std::array<CountedBit, 8>, 3> models;
    auto mixer = BitMixer<3>::with_weights(20'000);
    std::mt19937 noise(2);
    std::vector<bool> coded;
    for (std::size_t i = 0; i < kCount; ++i) {
      const std::array<CountedBit*, 3> used = {&models[0][first[i]], &models[1][second[i]],
                                               &models[2][noise() % 8]};
      BitMixer<3>::Inputs inputs;
      for (std::size_t k = 0; k < 3; ++k) inputs[k] = used[k]->stretch();
      const Probability16 p_one = mixer.p_one(inputs);
      const bool bit = coder.code_with(bits[i], p_one);
      mixer.template update<14>(inputs, p_one, bit);
      for (CountedBit* model : used) model->update<255>(bit);
      coded.push_back(bit);
    }
    return coded;
  };
  BitEncoder encoder;
  code_all(encoder);
  const auto bytes = encoder.finish();
  EXPECT_LT(8.0 * static_cast<double>(bytes.size()), 1.02 * entropy);

  BitDecoder decoder(bytes);
  const std::vector<bool> original = bits;
  bits.assign(kCount, false);
  EXPECT_EQ(code_all(decoder), original);
}

}  // namespace
}  // namespace pointreel
