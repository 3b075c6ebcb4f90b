// Everything that the fast range model learns while it codes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/bit_mixer.h"
#include "predict/symbol_tables.h"

namespace pointreel {

struct FastRangeState {
  static constexpr std::size_t kErrors = 20;  // octaves of the blend's recent squared error
  static constexpr std::size_t kSpreads = 4;  // four octaves each of how far the proposals lie apart
  static constexpr std::size_t kKinds = 5;    // of an alternative: none, start, above, above right, another
  static constexpr std::size_t kSides = 3;    // of its prediction, where the range to the left is
  static constexpr std::size_t kExponents = 28;

  SymbolTables<kErrors * kSpreads * kKinds * kSides> of_cell;
  SymbolTables<kKinds * 2> of_alternative;  // nearer or farther than the prediction
  std::array<CountedBit, kErrors> far_sign;
  std::array<CountedBit, kExponents> far_exponent;
};

// Shows a visitor all that adapts, in the order of the tables of priors (priors.h).
template <class State, class Visitor>
void visit_fast_range_state(State& state, Visitor& visitor) {
  visitor.symbols(state.of_cell);
  visitor.symbols(state.of_alternative);
  for (auto& bit : state.far_sign) visitor.bit(bit);
  for (auto& bit : state.far_exponent) visitor.bit(bit);
}

}  // namespace pointreel
