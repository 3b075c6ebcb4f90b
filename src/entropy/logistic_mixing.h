// Logistic mixing: the predictions of several contexts, weighted in the log-odds domain by weights that learn
// from every coded bit (Mahoney 2005). All of it is integer arithmetic.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/range_coder.h"

namespace pointreel {

// ln(p / (1 - p)) in units of 1/256.
using LogOdds = std::int32_t;
inline constexpr LogOdds kLogOddsUnit = 256;
inline constexpr LogOdds kMaxLogOdds = 1919;  // p = 65536 - 36: a probability the coder accepts

namespace mixing_tables {

inline constexpr int kStretchBits = 12;

// Both tables come from + - * / of doubles alone, in the compiler.
constexpr double exponential(double x) {
  double sum = 1, term = 1;
  const double eighth = x / 8;  // the series converges fast; the power is taken afterwards
  for (int i = 1; i < 24; ++i) {
    term = term * eighth / i;
    sum += term;
  }
  const double squared = sum * sum, fourth = squared * squared;
  return fourth * fourth;
}

constexpr auto make_squash() {
  std::array<std::uint16_t, 2 * kMaxLogOdds + 1> table{};
  for (LogOdds x = -kMaxLogOdds; x <= kMaxLogOdds; ++x) {
    const double p = 65536.0 / (1.0 + exponential(-static_cast<double>(x) / kLogOddsUnit));
    table[static_cast<std::size_t>(x + kMaxLogOdds)] = static_cast<std::uint16_t>(p + 0.5);
  }
  return table;
}
inline constexpr auto kSquash = make_squash();

// The log-odds whose squash is nearest below the middle of each of the 4096 classes of p.
constexpr auto make_stretch() {
  std::array<std::int16_t, 1 << kStretchBits> table{};
  LogOdds x = -kMaxLogOdds;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::uint32_t middle = static_cast<std::uint32_t>((i << (16 - kStretchBits)) + 8);
    while (x < kMaxLogOdds && kSquash[static_cast<std::size_t>(x + 1 + kMaxLogOdds)] <= middle) ++x;
    table[i] = static_cast<std::int16_t>(x);
  }
  return table;
}
inline constexpr auto kStretch = make_stretch();

}  // namespace mixing_tables

inline LogOdds stretch(Probability16 p_one) {
  return mixing_tables::kStretch[p_one >> (16 - mixing_tables::kStretchBits)];
}
inline Probability16 squash(LogOdds x) {
  return mixing_tables::kSquash[static_cast<std::size_t>(std::clamp(x, -kMaxLogOdds, kMaxLogOdds) +
                                                         kMaxLogOdds)];
}

// P(1) in one context: 22 bits of probability over a count. The n-th observation moves it by 1/(n + 1.5),
// until the rate reaches 1/limit; so it is a mean first and follows changes later.
class CountedBit {
 public:
  Probability16 p_one() const { return state_ >> 16; }
  std::uint32_t count() const { return state_ & kCountMask; }

  template <int kLimit>
  void update(bool bit) {
    const std::uint32_t n = count();
    const std::int32_t p = static_cast<std::int32_t>(state_ >> 10);
    const std::int64_t error = (bit ? (1 << 22) - 1 : 0) - p;
    const auto moved = p + static_cast<std::int32_t>((error * kRates[n]) >> 16);
    state_ = (static_cast<std::uint32_t>(moved) << 10) | (n < kLimit ? n + 1 : n);
  }

 private:
  static constexpr std::uint32_t kCountMask = 1023;
  static constexpr auto kRates = [] {  // in 1/65536
    std::array<std::int32_t, 1024> rates{};
    for (std::size_t n = 0; n < rates.size(); ++n) rates[n] = static_cast<std::int32_t>(131072 / (2 * n + 3));
    return rates;
  }();

  std::uint32_t state_ = 0x80000000u;
};

// One mixing network's sets of weights; the caller chooses a set for every bit.
template <std::size_t kInputs>
class LogisticMixer {
 public:
  using Inputs = std::array<LogOdds, kInputs>;

  // `initial_weight`: in 1/65536; about 1.3 times 65536 / kInputs when the contexts are related.
  LogisticMixer(std::size_t sets, std::int32_t initial_weight) : weights_(sets) {
    for (auto& set : weights_) set.fill(initial_weight);
  }

  LogOdds mix(std::size_t set, const Inputs& inputs) const {
    const auto& weights = weights_[set];
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < kInputs; ++i) sum += static_cast<std::int64_t>(weights[i]) * inputs[i];
    return static_cast<LogOdds>(std::clamp<std::int64_t>(sum >> 16, -kMaxLogOdds, kMaxLogOdds));
  }

  // `p_one`: what the mix of these inputs was squashed to. Weights move by error * input / 2^kRateShift; 14
  // adapts fast, 15 suits 10^5 decisions and more.
  template <int kRateShift>
  void update(std::size_t set, const Inputs& inputs, bool bit, Probability16 p_one) {
    const std::int32_t error = (bit ? 65536 : 0) - static_cast<std::int32_t>(p_one);
    auto& weights = weights_[set];
    for (std::size_t i = 0; i < kInputs; ++i) {
      // |error| < 2^16 and |input| < 2^11 fit. Weights wrap around, should they ever get that far.
      const std::int32_t change = (inputs[i] * error + (1 << (kRateShift - 1))) >> kRateShift;
      weights[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(weights[i]) +
                                             static_cast<std::uint32_t>(change));
    }
  }

 private:
  std::vector<std::array<std::int32_t, kInputs>> weights_;
};

}  // namespace pointreel
