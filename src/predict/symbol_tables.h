// Adaptive probabilities of sixteen symbols, many tables of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace pointreel {

inline constexpr std::size_t kSymbols = 16;

// A table holds 65536 P(symbol <= i), the last one 65535, so that all of it adapts in one SIMD operation.
struct alignas(32) SymbolTable {
  std::array<std::uint16_t, kSymbols> cumulative;
};

template <std::size_t kTables>
struct SymbolTables {
  std::array<SymbolTable, kTables> tables;
  std::array<std::uint8_t, kTables> count{};  // symbols seen, as far as the rate of learning depends on them

  SymbolTables() {
    for (SymbolTable& table : tables) {
      for (std::size_t i = 0; i < kSymbols; ++i)
        table.cumulative[i] = static_cast<std::uint16_t>((i + 1) * 65536 / kSymbols - 1);
    }
  }
};

}  // namespace pointreel
