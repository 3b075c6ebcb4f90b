// What a symbol says of a cell: its bin, as the distance from the one predicted, or where else to look.
//
//   0 .. 12     -(10..17) -(6..9) -(4,5) -3 -2 -1 0 1 2 3 4,5 6..9 10..17, with further bits
//   13, 14      near the first or second alternative (fast_range_model-inl.h)
//   15          far from all of them
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "predict/symbol_tables.h"

namespace pointreel {

struct BinSymbols {
  static constexpr std::size_t kZero = 6;
  static constexpr std::size_t kAlternative = 13;
  static constexpr std::size_t kFar = 15;
  static constexpr std::int32_t kMostNear = 17;  // bins from the prediction

  // The bins of a symbol: 2^bits of them, from the nearest one away from 0.
  struct Group {
    std::int32_t nearest;
    int bits;
  };
  std::array<Group, kSymbols> group{};
  std::array<std::uint8_t, 2 * kMostNear + 1> symbol{};  // of the bins from -kMostNear on

  constexpr BinSymbols() {
    std::int32_t nearest = 0;
    for (std::size_t size = 0; size <= kZero; ++size) {
      const int bits = size <= 3 ? 0 : static_cast<int>(size) - 3;
      group[kZero - size] = {-nearest, bits};
      group[kZero + size] = {nearest, bits};
      for (std::int32_t bin = nearest; bin < nearest + (1 << bits); ++bin) {
        symbol[static_cast<std::size_t>(kMostNear - bin)] = static_cast<std::uint8_t>(kZero - size);
        symbol[static_cast<std::size_t>(kMostNear + bin)] = static_cast<std::uint8_t>(kZero + size);
      }
      nearest += 1 << bits;
    }
  }
  std::size_t symbol_of(std::int32_t bin) const { return symbol[static_cast<std::size_t>(bin + kMostNear)]; }
};

// Tables, as branches on noise would be mispredicted.
inline constexpr BinSymbols kBinSymbols;

}  // namespace pointreel
