// Adaptive probabilities of sixteen symbols, many tables of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace pointreel {

inline constexpr std::size_t kSymbols = 16;

// A table holds 65536 P(symbol <= i), so that all of it adapts in one SIMD operation. The last one, which
// every symbol moves the same way, from 0 up to 65408, tells how much the table has learnt.
struct alignas(32) SymbolTable {
  std::array<std::uint16_t, kSymbols> cumulative{};

  // That nothing is known of.
  constexpr SymbolTable() {
    for (std::size_t i = 0; i + 1 < kSymbols; ++i)
      cumulative[i] = static_cast<std::uint16_t>((i + 1) * 65536 / kSymbols - 1);
  }

  // By which part tables move: 1/16 at first, 1/128 in the end.
  constexpr int learning_shift() const { return kLearningShifts[cumulative[kSymbols - 1] >> kShiftBits]; }

  static constexpr int kShiftBits = 10;
  static constexpr auto kLearningShifts = [] {
    std::array<std::uint8_t, std::size_t{1} << (16 - kShiftBits)> shifts{};
    for (std::size_t learnt = 0; learnt < shifts.size(); ++learnt)
      shifts[learnt] = static_cast<std::uint8_t>(learnt < 41 ? 4 : learnt < 55 ? 5 : learnt < 61 ? 6 : 7);
    return shifts;
  }();
};

template <std::size_t kTables>
using SymbolTables = std::array<SymbolTable, kTables>;

// What the last of a new table is after a number of symbols.
inline constexpr auto kLearntAfter = [] {
  std::array<std::uint16_t, 128> learnt{};
  SymbolTable table;
  for (std::size_t symbols = 0; symbols < learnt.size(); ++symbols) {
    auto& last = table.cumulative[kSymbols - 1];
    learnt[symbols] = last;
    last = static_cast<std::uint16_t>(last + ((65535 - last) >> table.learning_shift()));
  }
  return learnt;
}();

}  // namespace pointreel
