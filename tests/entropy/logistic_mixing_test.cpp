#include "entropy/logistic_mixing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "entropy/adaptive_models.h"

namespace pointreel {
namespace {

TEST(LogisticMixing, SquashAndStretchAreInverse) {
  for (LogOdds x = -kMaxLogOdds; x <= kMaxLogOdds; ++x) {
    const double p = 65536 / (1 + std::exp(-static_cast<double>(x) / kLogOddsUnit));
    EXPECT_NEAR(squash(x), p, 1);
    EXPECT_GE(squash(x), kMinProbability);
    EXPECT_LE(squash(x), 65536 - kMinProbability);
    // Stretch knows p to 1/4096: near the ends that is coarse.
    if (std::abs(x) < 4 * kLogOddsUnit) {
      EXPECT_NEAR(stretch(squash(x)), x, 8);
    }
  }
  EXPECT_EQ(squash(100'000), squash(kMaxLogOdds));
  EXPECT_EQ(squash(-100'000), squash(-kMaxLogOdds));
}

TEST(CountedBit, IsAMeanFirst) {
  CountedBit bit;
  EXPECT_EQ(bit.p_one(), 32768u);
  for (int i = 0; i < 100; ++i) {
    bit.update<255>(i % 4 == 0);
    EXPECT_EQ(bit.count(), static_cast<std::uint32_t>(i + 1));
  }
  EXPECT_NEAR(bit.p_one(), 65536 / 4, 700);
}

TEST(CountedBit, StaysAProbability) {
  for (const bool always : {false, true}) {
    CountedBit bit;
    for (int i = 0; i < 100'000; ++i) bit.update<30>(always);
    EXPECT_EQ(bit.count(), 30u);
    EXPECT_LT(bit.p_one(), 65536u);
    EXPECT_NEAR(bit.p_one(), always ? 65535 : 0, 10);
  }
}

// Two contexts, each of which sees one half of what decides the bit, and one that sees noise.
TEST(LogisticMixer, LearnsWhichInputsToTrust) {
  constexpr int kCount = 50'000;
  std::mt19937 random(1);
  std::vector<int> first, second;
  std::vector<bool> bits;
  for (int i = 0; i < kCount; ++i) {
    first.push_back(static_cast<int>(random() % 8));
    second.push_back(static_cast<int>(random() % 8));
    const double log_odds = 0.8 * (first.back() - 3.5) - 0.6 * (second.back() - 3.5);
    bits.push_back(std::uniform_real_distribution(0.0, 1.0)(random) < 1 / (1 + std::exp(-log_odds)));
  }
  const auto code_all = [&](auto& coder) {
    std::array<std::array<CountedBit, 8>, 3> models;
    LogisticMixer<3> mixer(1, 20'000);
    std::mt19937 noise(2);
    std::vector<bool> coded;
    for (std::size_t i = 0; i < kCount; ++i) {
      std::array<CountedBit*, 3> used = {&models[0][static_cast<std::size_t>(first[i])],
                                         &models[1][static_cast<std::size_t>(second[i])],
                                         &models[2][noise() % 8]};
      LogisticMixer<3>::Inputs inputs;
      for (std::size_t k = 0; k < 3; ++k) inputs[k] = stretch(used[k]->p_one());
      const Probability16 p_one = squash(mixer.mix(0, inputs));
      const bool bit = coder.code_with(bits[i], p_one);
      mixer.template update<14>(0, inputs, bit, p_one);
      for (CountedBit* model : used) model->update<255>(bit);
      coded.push_back(bit);
    }
    return coded;
  };
  BitEncoder encoder;
  code_all(encoder);
  const auto bytes = encoder.finish();

  double entropy = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double p = 1 / (1 + std::exp(-(0.8 * (first[i] - 3.5) - 0.6 * (second[i] - 3.5))));
    entropy -= p * std::log2(p) + (1 - p) * std::log2(1 - p);
  }
  EXPECT_LT(8.0 * static_cast<double>(bytes.size()), 1.02 * entropy);

  BitDecoder decoder(bytes);
  const std::vector<bool> original = bits;
  bits.assign(kCount, false);
  EXPECT_EQ(code_all(decoder), original);
}

}  // namespace
}  // namespace pointreel
