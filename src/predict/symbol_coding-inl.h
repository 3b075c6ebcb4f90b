// Codes symbols by adaptive tables: all cumulative probabilities of a table in a register or two.
//
// 16-bit integers throughout, so that nothing can differ between processors.

#if defined(POINTREEL_PREDICT_SYMBOL_CODING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_SYMBOL_CODING_INL_H_
#undef POINTREEL_PREDICT_SYMBOL_CODING_INL_H_
#else
#define POINTREEL_PREDICT_SYMBOL_CODING_INL_H_
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/lanes-inl.h"
#include "predict/symbol_tables.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Sixteen 16-bit lanes.
struct SymbolLanes {
  using Tag = hn::CappedTag<std::uint16_t, kSymbols>;
  static constexpr std::size_t kPartLanes = hn::MaxLanes(Tag());
  static constexpr std::size_t kParts = kSymbols / kPartLanes;
  hn::Vec<Tag> part[kParts];

  POINTREEL_INLINE SymbolLanes() {}
};

template <class Operation>
POINTREEL_INLINE SymbolLanes each_symbol(const Operation& operation) {
  SymbolLanes result;
  for (std::size_t i = 0; i < SymbolLanes::kParts; ++i) result.part[i] = operation(i);
  return result;
}
POINTREEL_INLINE SymbolLanes load_symbols(const std::uint16_t* lanes) {
  return each_symbol([&](std::size_t i) HWY_ATTR {
    return hn::Load(SymbolLanes::Tag(), lanes + i * SymbolLanes::kPartLanes);
  });
}
POINTREEL_INLINE void store(const SymbolLanes& a, std::uint16_t* lanes) {
  for (std::size_t i = 0; i < SymbolLanes::kParts; ++i)
    hn::Store(a.part[i], SymbolLanes::Tag(), lanes + i * SymbolLanes::kPartLanes);
}

// What P(symbol <= i) should have been, given the symbol; the last one is where learning ends.
inline constexpr auto kSymbolTargets = [] {
  std::array<SymbolTable, kSymbols> targets{};
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
    for (std::size_t i = 0; i < kSymbols; ++i)
      targets[symbol].cumulative[i] = i < symbol && i + 1 < kSymbols ? 0 : 0xFFFF;
  }
  return targets;
}();

// Moves a table towards the symbol.
POINTREEL_INLINE void learn(SymbolTable& table, const SymbolLanes& cumulative, std::size_t symbol) {
  const int shift = table.learning_shift();
  const SymbolLanes target = load_symbols(kSymbolTargets[symbol].cumulative.data());
  store(each_symbol([&](std::size_t i) HWY_ATTR {
          const auto away = hn::Xor(cumulative.part[i], target.part[i]);
          return hn::Xor(hn::Sub(away, hn::ShiftRightSame(away, shift)), target.part[i]);
        }),
        table.cumulative.data());
}

// Codes `symbol` (ignored when decoding) by a table, which learns it, and returns it.
template <class Coder>
POINTREEL_INLINE std::size_t code_symbol(Coder& coder, SymbolTable& table, std::size_t symbol) {
  constexpr int kWholeBits = 15;
  // In units of the whole, less 1/128 of it, which gives every symbol at least 8. The last one ends with the
  // whole, less 1, whatever the last of the table is: sums go no higher.
  static constexpr SymbolTable kLeast = [] {
    SymbolTable least;
    for (std::size_t i = 0; i < kSymbols; ++i) least.cumulative[i] = static_cast<std::uint16_t>(8 * (i + 1));
    least.cumulative[kSymbols - 1] = (1 << kWholeBits) - 1;
    return least;
  }();
  const SymbolLanes cumulative = load_symbols(table.cumulative.data());
  const SymbolLanes least = load_symbols(kLeast.cumulative.data());
  // All stay below 2^15, and signed is what processors compare.
  const hn::RebindToSigned<SymbolLanes::Tag> tag;
  const SymbolLanes ends = each_symbol([&](std::size_t i) HWY_ATTR {
    const auto half = hn::ShiftRight<1>(cumulative.part[i]);
    const auto share = hn::Sub(half, hn::ShiftRight<7>(half));
    return hn::BitCast(SymbolLanes::Tag(),
                       hn::SaturatedAdd(hn::BitCast(tag, share), hn::BitCast(tag, least.part[i])));
  });
  std::uint16_t borders[1 + kSymbols];
  borders[0] = 0;
  for (std::size_t i = 0; i < SymbolLanes::kParts; ++i)
    hn::StoreU(ends.part[i], SymbolLanes::Tag(), borders + 1 + i * SymbolLanes::kPartLanes);
  if constexpr (Coder::kDecodes) {
    const auto place = hn::Set(tag, static_cast<std::int16_t>(coder.next_place(kWholeBits)));
    symbol = kSymbols;
    for (const auto& part : ends.part) symbol -= hn::CountTrue(tag, hn::Gt(hn::BitCast(tag, part), place));
    symbol = symbol < kSymbols ? symbol : kSymbols - 1;
  }
  learn(table, cumulative, symbol);  // while it is still in registers
  coder.code_part(borders[symbol], std::uint32_t{borders[symbol + 1]} - borders[symbol], kWholeBits);
  return symbol;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
