// Codes symbols by adaptive tables: all sixteen cumulative probabilities of a table in a register or two.
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

// What P(symbol <= i) should have been, given the symbol.
inline constexpr auto kSymbolTargets = [] {
  std::array<SymbolTable, kSymbols> targets{};
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
    for (std::size_t i = 0; i < kSymbols; ++i)
      targets[symbol].cumulative[i] = i < symbol && i + 1 < kSymbols ? 0 : 0xFFFF;
  }
  return targets;
}();

// By how much tables learn after a number of symbols: 1/16 at first, 1/128 in the end.
inline constexpr std::uint8_t kSettled = 128;
inline constexpr auto kLearningShifts = [] {
  std::array<std::uint8_t, kSettled + 1> shifts{};
  for (std::size_t count = 0; count < shifts.size(); ++count)
    shifts[count] = static_cast<std::uint8_t>(count < 16 ? 4 : count < 48 ? 5 : count < kSettled ? 6 : 7);
  return shifts;
}();

// Moves a table towards the symbol.
template <std::size_t kTables>
POINTREEL_INLINE void learn(SymbolTables<kTables>& tables, std::size_t table, const SymbolLanes& cumulative,
                            std::size_t symbol) {
  std::uint8_t& count = tables.count[table];
  const int shift = kLearningShifts[count];
  count = static_cast<std::uint8_t>(count + (count < kSettled ? 1 : 0));
  const SymbolLanes target = load_symbols(kSymbolTargets[symbol].cumulative.data());
  store(each_symbol([&](std::size_t i) HWY_ATTR {
          const auto away = hn::Xor(cumulative.part[i], target.part[i]);
          return hn::Xor(hn::Sub(away, hn::ShiftRightSame(away, shift)), target.part[i]);
        }),
        tables.tables[table].cumulative.data());
}

// Codes `symbol` (ignored when decoding) with probabilities as of `cumulative`, and returns it.
// `learn(symbol)` is called before the coder moves on, so that tables are still in registers.
template <class Coder, class Learn>
POINTREEL_INLINE std::size_t code_symbol(Coder& coder, const SymbolLanes& cumulative, std::size_t symbol,
                                         const Learn& learn) {
  constexpr int kWholeBits = 15;
  constexpr std::uint32_t kWhole = 1U << kWholeBits;
  // In units of the whole, less 1/128 of it, which gives every symbol at least 8.
  static constexpr SymbolTable kLeast = [] {
    SymbolTable table{};
    for (std::size_t i = 0; i < kSymbols; ++i) table.cumulative[i] = static_cast<std::uint16_t>(8 * (i + 1));
    return table;
  }();
  const SymbolLanes least = load_symbols(kLeast.cumulative.data());
  const SymbolLanes ends = each_symbol([&](std::size_t i) HWY_ATTR {
    const auto half = hn::ShiftRight<1>(cumulative.part[i]);
    return hn::Add(hn::Sub(half, hn::ShiftRight<7>(half)), least.part[i]);
  });
  SymbolTable end;
  store(ends, end.cumulative.data());
  if constexpr (Coder::kDecodes) {
    // Both stay below 2^15, and signed comparisons are what processors have.
    const hn::RebindToSigned<SymbolLanes::Tag> tag;
    const auto place = hn::Set(tag, static_cast<std::int16_t>(coder.next_place(kWholeBits)));
    symbol = kSymbols;
    for (const auto& part : ends.part) symbol -= hn::CountTrue(tag, hn::Gt(hn::BitCast(tag, part), place));
    symbol = symbol < kSymbols ? symbol : kSymbols - 1;
  }
  const std::uint32_t first = symbol == 0 ? 0 : end.cumulative[symbol - 1];
  const std::uint32_t last = symbol + 1 == kSymbols ? kWhole : end.cumulative[symbol];
  learn(symbol);
  coder.code_part(first, last - first, kWholeBits);
  return symbol;
}

// The same by one table.
template <class Coder, std::size_t kTables>
POINTREEL_INLINE std::size_t code_symbol(Coder& coder, SymbolTables<kTables>& tables, std::size_t table,
                                         std::size_t symbol) {
  const SymbolLanes cumulative = load_symbols(tables.tables[table].cumulative.data());
  return code_symbol(coder, cumulative, symbol,
                     [&](std::size_t coded) HWY_ATTR { learn(tables, table, cumulative, coded); });
}

// By two tables, the first of which counts three times.
template <class Coder, std::size_t kTables, std::size_t kOtherTables>
POINTREEL_INLINE std::size_t code_symbol(Coder& coder, SymbolTables<kTables>& tables, std::size_t table,
                                         SymbolTables<kOtherTables>& other_tables, std::size_t other,
                                         std::size_t symbol) {
  const SymbolLanes a = load_symbols(tables.tables[table].cumulative.data());
  const SymbolLanes b = load_symbols(other_tables.tables[other].cumulative.data());
  const SymbolLanes mixed = each_symbol([&](std::size_t i) HWY_ATTR {
    return hn::AverageRound(a.part[i], hn::AverageRound(a.part[i], b.part[i]));
  });
  return code_symbol(coder, mixed, symbol, [&](std::size_t coded) HWY_ATTR {
    learn(tables, table, a, coded);
    learn(other_tables, other, b, coded);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
