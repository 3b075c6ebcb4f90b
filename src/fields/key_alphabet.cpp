#include "fields/key_alphabet.h"

#include <algorithm>

#include "fields/symbol_coding.h"

namespace pointreel {
namespace {

// Keys and a number for each, by open addressing; at most kMaxSymbols of them.
class KeyTable {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // Where the key is, or where it would go.
  std::uint32_t& number_of(std::uint64_t key) {
    std::size_t slot = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> (64 - kSlotBits));
    while (slots_[slot].number != kNone && slots_[slot].key != key) slot = (slot + 1) & (kSlots - 1);
    slots_[slot].key = key;
    return slots_[slot].number;
  }

 private:
  static constexpr int kSlotBits = 14;
  static constexpr std::size_t kSlots = std::size_t{1} << kSlotBits;
  static_assert(kSlots > 2 * kMaxSymbols);
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t number = kNone;
  };
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
};

}  // namespace

std::optional<std::vector<std::uint64_t>> distinct_keys(std::span<const std::uint64_t> keys) {
  std::vector<std::uint64_t> distinct;
  KeyTable table;
  for (const std::uint64_t key : keys) {
    std::uint32_t& number = table.number_of(key);
    if (number != KeyTable::kNone) continue;
    if (distinct.size() == kMaxSymbols) return std::nullopt;
    number = 0;
    distinct.push_back(key);
  }
  std::sort(distinct.begin(), distinct.end());
  return distinct;
}

std::vector<std::uint32_t> symbols_of(std::span<const std::uint64_t> keys,
                                      std::span<const std::uint64_t> alphabet) {
  KeyTable table;
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    table.number_of(alphabet[i]) = static_cast<std::uint32_t>(i);
  std::vector<std::uint32_t> symbols(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) symbols[i] = table.number_of(keys[i]);
  return symbols;
}

}  // namespace pointreel
