#include "fields/value_keys.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <type_traits>

namespace pointreel {
namespace {

constexpr std::uint64_t kMiddle = std::uint64_t{1} << 63;
constexpr double kMaxMultiple = 9007199254740992.0;  // 2^53: exact in a double
constexpr std::size_t kMaxListed = 512;              // distinct values that a step groups optimally

template <class T>
using BitsOf =
    std::conditional_t<sizeof(T) == 8, std::uint64_t,
                       std::conditional_t<sizeof(T) == 4, std::uint32_t,
                                          std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;

// Order-preserving: signed integers by flipping the sign bit, floats by flipping all bits of negative ones.
template <class T>
std::uint64_t ordered_bits(T value) {
  using Bits = BitsOf<T>;
  constexpr Bits kSign = static_cast<Bits>(Bits{1} << (8 * sizeof(T) - 1));
  const Bits bits = std::bit_cast<Bits>(value);
  if constexpr (std::is_floating_point_v<T>) return static_cast<Bits>(bits & kSign ? ~bits : bits | kSign);
  if constexpr (std::is_signed_v<T>) return static_cast<Bits>(bits ^ kSign);
  return bits;
}

template <class T>
T from_ordered_bits(std::uint64_t ordered) {
  using Bits = BitsOf<T>;
  constexpr Bits kSign = static_cast<Bits>(Bits{1} << (8 * sizeof(T) - 1));
  const Bits bits = static_cast<Bits>(ordered);
  if constexpr (std::is_floating_point_v<T>) {
    return std::bit_cast<T>(static_cast<Bits>(bits & kSign ? bits ^ kSign : ~bits));
  }
  if constexpr (std::is_signed_v<T>) return std::bit_cast<T>(static_cast<Bits>(bits ^ kSign));
  return std::bit_cast<T>(bits);
}

template <class T>
T multiple(std::int64_t k, double multiplier, double divisor) {
  return static_cast<T>(static_cast<double>(k) * multiplier / divisor);
}

// The k of value = k * multiplier / divisor, to the bit.
template <class T>
std::optional<std::int64_t> multiple_of(T value, double multiplier, double divisor) {
  const double k = static_cast<double>(value) / multiplier * divisor;
  if (!(std::fabs(k) < kMaxMultiple)) return std::nullopt;
  const std::int64_t rounded = std::llround(k);
  if (ordered_bits(multiple<T>(rounded, multiplier, divisor)) != ordered_bits(value)) return std::nullopt;
  return rounded;
}

// Largest unit that divides all distances, so that keys are small and dense.
void reduce(KeyedValues& keyed) {
  if (keyed.keys.empty()) return;
  const std::uint64_t base = *std::min_element(keyed.keys.begin(), keyed.keys.end());
  std::uint64_t unit = 0;
  for (const std::uint64_t key : keyed.keys) {
    if (unit == 1) break;
    if (const std::uint64_t distance = key - base; unit == 0 || distance % unit != 0)
      unit = std::gcd(unit, distance);
  }
  if (unit == 0) unit = 1;
  keyed.mapping.base = base;
  keyed.mapping.unit = unit;
  if (unit == 1) {
    for (std::uint64_t& key : keyed.keys) key -= base;
  } else {
    for (std::uint64_t& key : keyed.keys) key = (key - base) / unit;
  }
}

template <class T>
std::optional<KeyedValues> as_multiples(const std::vector<T>& values, double multiplier, double divisor) {
  const std::size_t most = values.size() / 32;
  KeyedValues keyed;
  keyed.mapping = {true, multiplier, divisor};
  keyed.keys.reserve(values.size());
  std::optional<std::uint64_t> before;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (const auto k = multiple_of(values[i], multiplier, divisor)) {
      // Exceptions at the start repeat the first key there is.
      if (!before) std::fill(keyed.keys.begin(), keyed.keys.end(), static_cast<std::uint64_t>(*k) + kMiddle);
      before = static_cast<std::uint64_t>(*k) + kMiddle;
    } else {
      keyed.exceptions.push_back({static_cast<std::uint32_t>(i), ordered_bits(values[i])});
      if (keyed.exceptions.size() > most) return std::nullopt;
    }
    keyed.keys.push_back(before.value_or(kMiddle));
  }
  return keyed;
}

template <class T>
KeyedValues keyed_from(const std::vector<T>& values, double step) {
  if constexpr (std::is_floating_point_v<T>) {
    if (step > 0) {
      if (auto keyed = as_multiples(values, 2 * step, 1)) return *std::move(keyed);
    }
    for (const double divisor : {1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e9, 255.0, 256.0, 65535.0, 65536.0}) {
      if (auto keyed = as_multiples(values, 1, divisor)) return *std::move(keyed);
    }
  }
  KeyedValues keyed;
  keyed.keys.reserve(values.size());
  for (const T value : values) keyed.keys.push_back(ordered_bits(value));
  return keyed;
}

template <class T>
bool within(T a, T b, double step) {
  if constexpr (std::is_integral_v<T>) {
    const std::uint64_t distance =
        a > b ? ordered_bits(a) - ordered_bits(b) : ordered_bits(b) - ordered_bits(a);
    return step >= 18446744073709551615.0 || distance <= static_cast<std::uint64_t>(step);
  } else {
    return std::fabs(static_cast<double>(a) - static_cast<double>(b)) <= step;
  }
}

template <class T>
bool is_number(T value) {
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}

// Fewest representatives: each is the largest value within the step of the smallest one not yet covered, and
// stands for all within the step above itself.
template <class T>
std::vector<T> grouped(const std::vector<T>& values, const std::vector<T>& distinct, double step) {
  std::vector<T> representative(distinct.size());
  for (std::size_t i = 0; i < distinct.size();) {
    std::size_t middle = i;
    while (middle + 1 < distinct.size() && within(distinct[middle + 1], distinct[i], step)) ++middle;
    const std::size_t first = i;
    for (i = middle; i < distinct.size() && within(distinct[i], distinct[middle], step);) ++i;
    std::fill(representative.begin() + static_cast<std::ptrdiff_t>(first),
              representative.begin() + static_cast<std::ptrdiff_t>(i), distinct[middle]);
  }
  std::vector<T> result = values;
  for (T& value : result) {
    if (!is_number(value)) continue;
    value = representative[static_cast<std::size_t>(
        std::lower_bound(distinct.begin(), distinct.end(), value) - distinct.begin())];
  }
  return result;
}

// The nearest multiple of twice the step; a neighbour of it or the value itself where rounding breaks the
// bound.
template <class T>
T snapped(T value, double step) {
  if constexpr (std::is_floating_point_v<T>) {
    const double k = static_cast<double>(value) / (2 * step);
    if (!(std::fabs(k) < kMaxMultiple)) return value;
    const std::int64_t nearest = std::llround(k);
    for (const std::int64_t candidate : {nearest, nearest - 1, nearest + 1}) {
      const T result = multiple<T>(candidate, 2 * step, 1);
      if (within(result, value, step)) return result;
    }
    return value;
  } else {
    if (!(step < 4611686018427387904.0)) return value;
    const std::uint64_t reach = static_cast<std::uint64_t>(step), quantum = 2 * reach + 1;
    const std::uint64_t bits = ordered_bits(value);
    const std::uint64_t centre = bits / quantum * quantum + reach;
    constexpr std::uint64_t kLargest = static_cast<BitsOf<T>>(~BitsOf<T>{0});
    return centre > kLargest || centre < reach ? value : from_ordered_bits<T>(centre);
  }
}

// Nothing when there are more than kMaxListed.
template <class T>
std::optional<std::vector<T>> few_distinct(const std::vector<T>& values) {
  std::vector<T> distinct;
  for (const T value : values) {
    if (!is_number(value)) continue;
    const auto place = std::lower_bound(distinct.begin(), distinct.end(), value);
    if (place != distinct.end() && *place == value) continue;
    if (distinct.size() == kMaxListed) return std::nullopt;
    distinct.insert(place, value);
  }
  return distinct;
}

}  // namespace

KeyedValues to_keys(const FieldValues& values, double step) {
  KeyedValues keyed = std::visit([&](const auto& v) { return keyed_from(v, step); }, values);
  reduce(keyed);
  return keyed;
}

FieldValues coarsened(const FieldValues& values, double step) {
  return std::visit(
      [&]<class T>(const std::vector<T>& v) -> FieldValues {
        if (const auto distinct = few_distinct(v)) return grouped(v, *distinct, step);
        std::vector<T> result = v;
        for (T& value : result) value = is_number(value) ? snapped(value, step) : value;
        return result;
      },
      values);
}

namespace {

template <class T>
std::vector<T> values_from(const KeyedValues& keyed) {
  std::vector<T> values;
  values.reserve(keyed.keys.size());
  const KeyMapping& mapping = keyed.mapping;
  for (const std::uint64_t key : keyed.keys) {
    const std::uint64_t x = mapping.base + mapping.unit * key;
    if constexpr (std::is_floating_point_v<T>) {
      if (mapping.multiples) {
        values.push_back(
            multiple<T>(std::bit_cast<std::int64_t>(x - kMiddle), mapping.multiplier, mapping.divisor));
        continue;
      }
    }
    values.push_back(from_ordered_bits<T>(x));
  }
  for (const KeyException& exception : keyed.exceptions) {
    values[exception.point] = from_ordered_bits<T>(exception.bits);
  }
  return values;
}

template <std::size_t kType = 0>
FieldValues values_of_type(const KeyedValues& keyed, std::size_t type) {
  if constexpr (kType + 1 < std::variant_size_v<FieldValues>) {
    if (type != kType) return values_of_type<kType + 1>(keyed, type);
  }
  return values_from<typename std::variant_alternative_t<kType, FieldValues>::value_type>(keyed);
}

}  // namespace

FieldValues from_keys(const KeyedValues& keyed, std::size_t type) {
  return values_of_type(keyed, type);
}

}  // namespace pointreel
