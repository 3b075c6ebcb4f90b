#include "fields/field_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "entropy/plain_bits.h"
#include "entropy/wide_integer.h"
#include "fields/key_alphabet.h"
#include "fields/residual_coding.h"
#include "fields/symbol_coding.h"
#include "fields/value_keys.h"

namespace pointreel {
namespace {

enum class FieldMethod : std::uint8_t { constant, symbols, residuals };

// The values of a sweep, as ascending x (KeyMapping), and what their symbols learned. Good for a later sweep,
// too, as long as that has no other values.
struct Alphabet {
  KeyMapping mapping;  // base 0, unit 1
  std::vector<std::uint64_t> keys;
  SymbolModel model;
};

}  // namespace

struct FieldMemory::State {
  std::optional<Alphabet> alphabet;
  ResidualModel residuals;
};

FieldMemory::FieldMemory() : state_(std::make_unique<State>()) {}
FieldMemory::~FieldMemory() = default;
FieldMemory::FieldMemory(FieldMemory&&) noexcept = default;
FieldMemory& FieldMemory::operator=(FieldMemory&&) noexcept = default;

namespace {

template <class Coder>
void code_mapping(Coder& coder, KeyMapping& mapping) {
  mapping.multiples = coder.code_even(mapping.multiples);
  if (mapping.multiples) {
    mapping.multiplier =
        std::bit_cast<double>(code_plain_bits(coder, std::bit_cast<std::uint64_t>(mapping.multiplier), 64));
    mapping.divisor =
        std::bit_cast<double>(code_plain_bits(coder, std::bit_cast<std::uint64_t>(mapping.divisor), 64));
  }
  mapping.base = code_plain_bits(coder, mapping.base, 64);
  AdaptiveWideInteger unit(0);
  mapping.unit = unit.code(coder, mapping.unit);
}

// False when the bytes cannot be right.
template <class Coder>
bool code_exceptions(Coder& coder, std::vector<KeyException>& exceptions, std::size_t points) {
  AdaptiveWideInteger counts(0);
  const std::uint64_t count = counts.code(coder, exceptions.size());
  if (count > points) return false;
  AdaptiveWideInteger gaps(3);
  AdaptiveBit repeats;
  std::uint64_t next = 0, bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if constexpr (Coder::kDecodes) {
      if (coder.overran()) return false;
      exceptions.push_back({});
    }
    KeyException& exception = exceptions[i];
    const std::uint64_t gap = gaps.code(coder, exception.point - next);
    if (gap >= points - next) return false;
    exception.point = static_cast<std::uint32_t>(next + gap);
    next = exception.point + std::uint64_t{1};
    if (!coder.code(repeats, exception.bits == bits)) bits = code_plain_bits(coder, exception.bits, 64);
    exception.bits = bits;
  }
  return true;
}

// The distinct keys (ascending; `keys` is empty in a decoder) and their weights, powers of two about as large
// as the counts.
template <class Coder>
bool code_alphabet(Coder& coder, std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& weights) {
  AdaptiveWideInteger counts(0);
  const std::uint64_t count = counts.code(coder, keys.size());
  if (count == 0 || count > kMaxSymbols) return false;
  keys.resize(count);
  weights.resize(count);
  AdaptiveWideInteger gaps(4);
  AdaptiveInteger changes;
  std::uint64_t before = ~std::uint64_t{0};
  std::int32_t length = 0;
  for (std::size_t i = 0; i < count; ++i) {
    keys[i] = before + 1 + gaps.code(coder, keys[i] - before - 1);
    before = keys[i];
    length += changes.code(coder, static_cast<std::int32_t>(std::bit_width(weights[i])) - length);
    if (length < 1 || length > 32) return false;
    weights[i] = std::uint64_t{1} << (length - 1);
  }
  return true;
}

KeyMapping without_reduction(KeyMapping mapping) {
  mapping.base = 0;
  mapping.unit = 1;
  return mapping;
}

// Fills the gaps of a nearly dense alphabet: the table shortens, and a later sweep finds its values in it.
void fill_gaps(std::vector<std::uint64_t>& keys) {
  const std::uint64_t span = keys.back() - keys.front();
  if (span >= keys.size() + keys.size() / 2 || span >= kMaxSymbols) return;
  const std::uint64_t first = keys.front();
  keys.resize(span + 1);
  std::iota(keys.begin(), keys.end(), first);
}

// The part of the bytes that both methods share is the mapping; `coder` has read or written the method
// before.
template <class Coder>
bool code_symbols(Coder& coder, KeyedValues& keyed, std::vector<std::uint64_t> alphabet,
                  const PointLayout& layout, std::optional<Alphabet>& known) {
  std::vector<std::uint32_t> symbols(keyed.keys.size());  // by the output's order
  bool reuse = false;
  if constexpr (!Coder::kDecodes) {
    const auto x_of = [&](std::uint64_t key) { return keyed.mapping.base + keyed.mapping.unit * key; };
    reuse = known && known->mapping == without_reduction(keyed.mapping) &&
            std::all_of(alphabet.begin(), alphabet.end(), [&](std::uint64_t key) {
              return std::binary_search(known->keys.begin(), known->keys.end(), x_of(key));
            });
    if (reuse) {
      for (std::uint64_t& key : keyed.keys) key = x_of(key);
    } else {
      fill_gaps(alphabet);
    }
    symbols = symbols_of(keyed.keys, reuse ? known->keys : alphabet);
  }
  reuse = coder.code_even(reuse);
  if (reuse && !known) return false;
  if (!reuse) {
    code_mapping(coder, keyed.mapping);
    std::vector<std::uint64_t> weights(alphabet.size(), 1);
    for (std::size_t i = 0; i < symbols.size() && !Coder::kDecodes; ++i) ++weights[symbols[i]];
    if (!code_alphabet(coder, alphabet, weights)) return false;
    for (std::uint64_t& key : alphabet) key = keyed.mapping.base + keyed.mapping.unit * key;
    known.emplace(
        Alphabet{without_reduction(keyed.mapping), std::move(alphabet), SymbolModel(weights, layout.rows())});
  }
  keyed.mapping = known->mapping;

  std::vector<std::uint32_t> in_raster(symbols.size());
  const auto places = layout.raster();
  for (std::size_t i = 0; i < places.size(); ++i) in_raster[i] = symbols[places[i].point];
  known->model.code(coder, layout, in_raster);
  if constexpr (Coder::kDecodes) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (in_raster[i] >= known->keys.size()) return false;
      keyed.keys[places[i].point] = known->keys[in_raster[i]];
    }
  }
  return true;
}

// All of a field; `plan` says what a decoder reads. False when the bytes cannot be right.
struct Plan {
  FieldMethod method = FieldMethod::constant;
  KeyPredictor predictor = KeyPredictor::before;
  std::vector<std::uint64_t> alphabet;
};

template <class Coder>
bool code_field(Coder& coder, KeyedValues& keyed, Plan plan, const PointLayout& layout,
                FieldMemory::State& state) {
  plan.method = static_cast<FieldMethod>(code_plain_bits(coder, static_cast<std::uint64_t>(plan.method), 2));
  switch (plan.method) {
    case FieldMethod::constant:
      code_mapping(coder, keyed.mapping);
      break;
    case FieldMethod::symbols:
      if (!code_symbols(coder, keyed, std::move(plan.alphabet), layout, state.alphabet)) return false;
      break;
    case FieldMethod::residuals: {
      code_mapping(coder, keyed.mapping);
      const std::uint64_t predictor = code_plain_bits(coder, static_cast<std::uint64_t>(plan.predictor), 3);
      if (predictor >= kKeyPredictors) return false;
      state.residuals.code(coder, static_cast<KeyPredictor>(predictor), layout, keyed.keys);
      break;
    }
    default:
      return false;
  }
  return code_exceptions(coder, keyed.exceptions, keyed.keys.size());
}

double entropy_bits(std::span<const double> counts) {
  const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
  double bits = 0;
  for (const double count : counts) bits -= count > 0 ? count * std::log2(count / total) : 0;
  return bits;
}

// What methods are compared by: the middle of the sweep, where whole rows are full.
PointRun sample_of(const PointLayout& layout) {
  constexpr std::size_t kSampled = 16384;
  const std::size_t count = std::min(layout.size(), kSampled);
  return {(layout.size() - count) / 2, count};
}

// Bits that `ResidualModel` will take for the run, about: the lengths' entropy and the bits below the leading
// ones.
double residual_cost_bits(KeyPredictor predictor, const KeyedValues& keyed, const PointLayout& layout,
                          PointRun run) {
  std::array<double, 65> lengths{};
  predict_keys(predictor, layout, run, [&](std::uint32_t point, std::uint64_t prediction) {
    const std::uint64_t key = keyed.keys[point];
    ++lengths[static_cast<std::size_t>(std::bit_width(zigzag(key - prediction)))];
    return key;
  });
  double bits = entropy_bits(lengths);
  for (std::size_t length = 2; length < lengths.size(); ++length)
    bits += lengths[length] * static_cast<double>(length - 1);
  return bits;
}

// Bits that `SymbolModel` will take for the run, about: the entropy given the symbol to the left, coarsely,
// of which the other contexts save a tenth, and the run's share of a byte a value for the table.
double symbol_cost_bits(std::span<const std::uint64_t> keys, const std::vector<std::uint64_t>& alphabet,
                        const PointLayout& layout, PointRun run) {
  constexpr std::size_t kClasses = 16;
  std::vector<std::vector<double>> counts(kClasses, std::vector<double>(alphabet.size(), 0));
  std::vector<std::uint64_t> keys_of_run;
  for (const PointLayout::Place& place : layout.raster().subspan(run.first, run.count))
    keys_of_run.push_back(keys[place.point]);
  std::size_t left = 0;
  for (const std::uint32_t symbol : symbols_of(keys_of_run, alphabet)) {
    ++counts[left * kClasses / alphabet.size()][symbol];
    left = symbol;
  }
  double bits = 8 * static_cast<double>(alphabet.size()) * static_cast<double>(run.count) /
                static_cast<double>(layout.size());
  for (const auto& counts_after : counts) bits += 0.9 * entropy_bits(counts_after);
  return bits;
}

Plan plan_for(const KeyedValues& keyed, const PointLayout& layout) {
  Plan plan;
  if (std::all_of(keyed.keys.begin(), keyed.keys.end(), [](std::uint64_t key) { return key == 0; }))
    return plan;
  plan.method = FieldMethod::residuals;
  const PointRun sample = sample_of(layout);
  double best_bits = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kKeyPredictors; ++i) {
    const double bits = residual_cost_bits(static_cast<KeyPredictor>(i), keyed, layout, sample);
    if (bits < best_bits) {
      best_bits = bits;
      plan.predictor = static_cast<KeyPredictor>(i);
    }
  }
  if (auto alphabet = distinct_keys(keyed.keys);
      alphabet && symbol_cost_bits(keyed.keys, *alphabet, layout, sample) < best_bits) {
    plan.method = FieldMethod::symbols;
    plan.alphabet = *std::move(alphabet);
  }
  return plan;
}

}  // namespace

std::vector<std::uint8_t> encode_field(const FieldValues& values, double step, const PointLayout& layout,
                                       FieldMemory& memory) {
  KeyedValues keyed = to_keys(step > 0 ? coarsened(values, step) : values, step);
  BitEncoder coder;
  code_field(coder, keyed, plan_for(keyed, layout), layout, memory.state());
  return coder.finish();
}

Result<FieldValues> decode_field(std::span<const std::uint8_t> bytes, std::size_t type,
                                 const PointLayout& layout, FieldMemory& memory) {
  if (type >= std::variant_size_v<FieldValues>) return Error{ErrorCode::corrupt, "a field of unknown type"};
  BitDecoder coder(bytes);
  KeyedValues keyed;
  keyed.keys.resize(layout.size(), 0);
  const bool sane = code_field(coder, keyed, {}, layout, memory.state());
  if (coder.overran()) return Error{ErrorCode::truncated, "the bytes of a field end before its last value"};
  if (!sane) return Error{ErrorCode::corrupt, "the bytes of a field contradict themselves"};
  // Others could make NaNs, whose bits depend on the processor.
  const KeyMapping& mapping = keyed.mapping;
  if (mapping.multiples &&
      !(mapping.multiplier > 0 && mapping.multiplier <= std::numeric_limits<double>::max() &&
        mapping.divisor >= 1 && mapping.divisor <= std::numeric_limits<double>::max())) {
    return Error{ErrorCode::corrupt, "the values of a field are multiples of nothing"};
  }
  return from_keys(keyed, type);
}

}  // namespace pointreel
