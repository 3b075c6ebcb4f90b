// Turns what the models have learnt into tables of priors.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "predict/priors.h"

namespace pointreel {

// A visitor of states (visit_range_state, visit_hit_mask_state): the mean of the numbers that it has seen.
class PriorMean {
 public:
  // Before each visit.
  void start_visit() { next_ = 0; }

  void logarithm(const float& value) { add(kPriorsPerOctave * std::log2(static_cast<double>(value))); }
  void weight(const float& value) { add(kPriorsPerWeight * static_cast<double>(value)); }
  // What has counted most bits knows best: the last state.
  void bit(const CountedBit& bit) { set(byte_of(bit.p_one(), bit.count())); }
  void bits_by_row(const CountedBit* bits, std::size_t rows, std::size_t per_row) {
    for (std::size_t i = 0; i < per_row; ++i) {
      double sum = 0, seen = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        const CountedBit& bit = bits[row * per_row + i];
        sum += static_cast<double>(bit.p_one()) * bit.count();
        seen += bit.count();
      }
      constexpr std::uint32_t kRowsDiffer = 20;  // bits that count at most
      set(byte_of(seen > 0 ? static_cast<Probability16>(sum / seen) : 32768U, seen > 0 ? kRowsDiffer : 0));
    }
  }

  // Of the rows that have learnt anything.
  void weights_by_row(const float* weights, std::size_t rows, std::size_t per_row) {
    for (std::size_t i = 0; i < per_row; ++i) {
      double sum = 0, seen = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        const float value = weights[row * per_row + i];
        sum += static_cast<double>(value);
        seen += value != 0 ? 1 : 0;
      }
      weight(seen > 0 ? static_cast<float>(sum / seen) : 0);
    }
  }

  // How much tables differ between sweeps says how much their priors count for: little.
  template <std::size_t kTables>
  void symbols(const SymbolTables<kTables>& tables) {
    constexpr int kMostCount = 48;
    for (const SymbolTable& table : tables) {
      const auto* learnt = std::lower_bound(kLearntAfter.begin(), kLearntAfter.begin() + 2 * kMostCount,
                                            table.cumulative[kSymbols - 1]);
      set(static_cast<int>(learnt - kLearntAfter.begin()) / 2);
      int before = 0;
      for (std::size_t i = 0; i < kSymbols; ++i) {
        const int end = i + 1 < kSymbols ? table.cumulative[i] : 65535;
        logarithm(static_cast<float>(end - before + 16) / 65536);
        before = end;
      }
    }
  }

  // As C++ source, one table.
  void print(const std::string& name) const {
    fmt::print("constexpr std::int8_t {}[] = {{\n", name);
    std::string line = "   ";
    for (const Number& number : numbers_) {
      const double value = number.sum / number.count;
      const std::string item =
          fmt::format(" {},", std::clamp(static_cast<int>(std::lround(value)), -128, 127));
      if (line.size() + item.size() > 110) {
        fmt::print("{}\n", line);
        line = "   ";
      }
      line += item;
    }
    fmt::print("{}\n}};\n", line);
  }

 private:
  struct Number {
    double sum = 0, count = 0;
  };

  // The byte that state_from_priors() reads. Priors count for half as many bits as training saw, at most.
  static int byte_of(Probability16 p_one, std::uint32_t count) {
    int level = 0;
    for (int i = 1; i < 4; ++i) {
      if (count >= 2U * kPriorCounts[static_cast<std::size_t>(i)]) level = i;
    }
    const int step = std::clamp((stretch(p_one) + kMaxStretch) / kPriorStep, 0, 63);
    return static_cast<std::int8_t>((count == 0 ? 32 : step) << 2 | level);
  }

  Number& number() {
    if (next_ == numbers_.size()) numbers_.push_back({});
    return numbers_[next_++];
  }
  void add(double value) {
    Number& at = number();
    at.sum += value;
    at.count += 1;
  }
  void set(int value) { number() = {static_cast<double>(value), 1}; }

  std::size_t next_ = 0;
  std::vector<Number> numbers_;
};

}  // namespace pointreel
