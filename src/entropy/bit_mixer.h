// Mixing several predictions of one bit: each is stretched to ln(p / (1 - p)), a weighted sum of those is
// squashed back to a probability, and the weights follow the gradient of the code length (Mattern 2013;
// Mahoney's lpaq).
//
// All of it is integer arithmetic; the tables are made at compile time from + - * / alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/range_coder.h"

namespace pointreel {

// ln(p / (1 - p)) in units of 1/256, within +-kMaxStretch.
using Stretch = std::int32_t;
inline constexpr Stretch kMaxStretch = 2047;

namespace bit_mixer_detail {

// e^x for |x| <= 8: Taylor's series at x / 16, then four squarings.
constexpr double exponential(double x) {
  const double small = x / 16;
  double term = 1;
  double sum = 1;
  for (int k = 1; k < 14; ++k) {
    term = term * small / k;
    sum += term;
  }
  for (int k = 0; k < 4; ++k) sum *= sum;
  return sum;
}

constexpr auto make_squash_table() {
  std::array<std::uint16_t, 2 * kMaxStretch + 1> table{};
  for (Stretch s = -kMaxStretch; s <= kMaxStretch; ++s) {
    const double p = 1 / (1 + exponential(-s / 256.0));
    table[static_cast<std::size_t>(s + kMaxStretch)] = static_cast<std::uint16_t>(p * 65536 + 0.5);
  }
  return table;
}
inline constexpr auto kSquash = make_squash_table();

inline constexpr int kStretchIndexBits = 12;

// The inverse of kSquash: the least stretch whose probability reaches the middle of the entry's interval.
constexpr auto make_stretch_table() {
  std::array<std::int16_t, 1 << kStretchIndexBits> table{};
  Stretch s = -kMaxStretch;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::size_t p = (i << (kProbabilityBits - kStretchIndexBits)) + 8;
    while (s < kMaxStretch && kSquash[static_cast<std::size_t>(s + kMaxStretch)] < p) ++s;
    table[i] = static_cast<std::int16_t>(s);
  }
  return table;
}
inline constexpr auto kStretch = make_stretch_table();

}  // namespace bit_mixer_detail

// P(1) in units of 1/65536 for a stretch within +-kMaxStretch.
inline Probability16 squash(Stretch stretch) {
  return bit_mixer_detail::kSquash[static_cast<std::size_t>(stretch + kMaxStretch)];
}

// The stretch of a probability.
inline Stretch stretch(Probability16 p_one) {
  return bit_mixer_detail::kStretch[p_one >> (kProbabilityBits - bit_mixer_detail::kStretchIndexBits)];
}

// P(1) as the mean of the bits seen, a prior counting as a number of them: the n-th bit moves it by 1 / (n
// + 1.5), until n reaches a limit.
class CountedBit {
 public:
  static constexpr std::uint32_t kMaxCount = 1023;

  constexpr CountedBit() = default;
  CountedBit(Probability16 p_one, std::uint32_t count) : state_(p_one << 16 | count) {}

  Probability16 p_one() const { return state_ >> 16; }
  std::uint32_t count() const { return state_ & kMaxCount; }
  Stretch stretch() const {
    return bit_mixer_detail::kStretch[state_ >> (32 - bit_mixer_detail::kStretchIndexBits)];
  }

  template <std::uint32_t kLimit = kMaxCount>
  void update(bool bit) {
    const std::uint32_t n = count();
    const auto p = static_cast<std::int64_t>(state_ >> kCountBits);
    const std::int64_t target = bit ? (1 << kFractionBits) - 1 : 0;
    const std::int64_t moved = p + (((target - p) * kRates[n]) >> 16);
    state_ = static_cast<std::uint32_t>(moved) << kCountBits | (n + (n < kLimit ? 1 : 0));
  }

 private:
  static constexpr int kCountBits = 10;
  static constexpr int kFractionBits = 32 - kCountBits;
  static constexpr auto kRates = [] {
    std::array<std::int32_t, kMaxCount + 1> rates{};
    for (std::size_t n = 0; n < rates.size(); ++n)
      rates[n] = static_cast<std::int32_t>(std::size_t{2} * 65536 / (2 * n + 3));
    return rates;
  }();

  std::uint32_t state_ = 1u << 31;  // P(1) in the upper 22 bits, the count in the lower 10
};

// One set of weights, for the inputs that go with it.
template <std::size_t kInputs>
class BitMixer {
 public:
  using Inputs = std::array<Stretch, kInputs>;
  static constexpr std::int32_t kOne = 1 << 16;  // the weight 1.0

  // All inputs weigh the same; inputs that say related things do best with about 1.3 in sum.
  static BitMixer with_weights(std::int32_t weight) {
    BitMixer mixer;
    mixer.weights_.fill(weight);
    return mixer;
  }

  std::int32_t weight(int input) const { return weights_[static_cast<std::size_t>(input)]; }
  void set_weight(int input, std::int32_t weight) { weights_[static_cast<std::size_t>(input)] = weight; }

  // Within what the coders accept.
  Probability16 p_one(const Inputs& inputs) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < kInputs; ++i) sum += static_cast<std::int64_t>(weights_[i]) * inputs[i];
    const auto mixed = std::clamp<std::int64_t>(sum >> 16, -kMaxStretch, kMaxStretch);
    return std::clamp(squash(static_cast<Stretch>(mixed)), kMinProbability, 65536 - kMinProbability);
  }

  // `p_one` is what the mixer gave for these inputs. Weights move by error * input / 2^kRateShift: 17
  // is about 0.002 of the gradient, and 14 adapts within some hundred bits.
  template <int kRateShift = 17>
  void update(const Inputs& inputs, Probability16 p_one, bool bit) {
    const std::int32_t error = (bit ? 65536 : 0) - static_cast<std::int32_t>(p_one);
    for (std::size_t i = 0; i < kInputs; ++i) {
      const std::int32_t step = (inputs[i] * error + (1 << (kRateShift - 1))) >> kRateShift;
      weights_[i] = std::clamp(weights_[i] + step, -kLimit, kLimit);
    }
  }

 private:
  static constexpr std::int32_t kLimit = 16 * kOne;  // whatever the bytes say, nothing overflows

  std::array<std::int32_t, kInputs> weights_{};
};

}  // namespace pointreel
