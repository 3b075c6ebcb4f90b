// A field's values as unsigned integers that keep their order: what the coders of fields work on.
#pragma once

#include <cstdint>
#include <vector>

#include "pointreel/point_cloud.h"

namespace pointreel {

// key = (x - base) / unit, where x is either the value's bits, mapped so that they ascend as the values do,
// or (for floating point) the k of value = k * multiplier / divisor.
struct KeyMapping {
  bool multiples = false;
  double multiplier = 1, divisor = 1;
  std::uint64_t base = 0, unit = 1;
  friend bool operator==(const KeyMapping&, const KeyMapping&) = default;
};

// A point whose value is no multiple (NaN among multiples, say): the bits of its value, mapped.
struct KeyException {
  std::uint32_t point = 0;
  std::uint64_t bits = 0;
};

struct KeyedValues {
  KeyMapping mapping;
  std::vector<std::uint64_t> keys;       // one a point; that of an exception repeats the key before it
  std::vector<KeyException> exceptions;  // by ascending point
};

// Exact. `step`: that of coarsened(), 0 when there was none; it hints at the multiples to look for.
KeyedValues to_keys(const FieldValues& values, double step);
FieldValues from_keys(const KeyedValues& keyed, std::size_t type);  // any keys give some values

// Values moved by at most the step (field_coding.h), so that fewer different ones remain.
FieldValues coarsened(const FieldValues& values, double step);

}  // namespace pointreel
