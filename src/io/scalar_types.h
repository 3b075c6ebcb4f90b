// The ten scalar types a field can have, and how one value is stored as bytes or as text.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "pointreel/point_cloud.h"

namespace pointreel::io {

// In the order of FieldValues' alternatives.
enum class ScalarType : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
};

inline ScalarType scalar_type_of(const FieldValues& values) {
  return static_cast<ScalarType>(values.index());
}

// Calls f.template operator()<T>() with the C++ type that `type` stands for.
template <class F>
decltype(auto) visit_scalar_type(ScalarType type, F&& f) {
  switch (type) {
    case ScalarType::int8:
      return f.template operator()<std::int8_t>();
    case ScalarType::uint8:
      return f.template operator()<std::uint8_t>();
    case ScalarType::int16:
      return f.template operator()<std::int16_t>();
    case ScalarType::uint16:
      return f.template operator()<std::uint16_t>();
    case ScalarType::int32:
      return f.template operator()<std::int32_t>();
    case ScalarType::uint32:
      return f.template operator()<std::uint32_t>();
    case ScalarType::int64:
      return f.template operator()<std::int64_t>();
    case ScalarType::uint64:
      return f.template operator()<std::uint64_t>();
    case ScalarType::float32:
      return f.template operator()<float>();
    case ScalarType::float64:
      break;
  }
  return f.template operator()<double>();
}

inline std::size_t size_of(ScalarType type) {
  return visit_scalar_type(type, []<class T>() { return sizeof(T); });
}

inline bool is_float(ScalarType type) {
  return visit_scalar_type(type, []<class T>() { return std::is_floating_point_v<T>; });
}

inline FieldValues make_values(ScalarType type, std::size_t count) {
  return visit_scalar_type(type, [&]<class T>() { return FieldValues(std::vector<T>(count)); });
}

// --- bytes ---

template <class T>
T load(const char* bytes, std::endian byte_order) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (byte_order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

template <class T>
void store_little_endian(char* bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  std::memcpy(bytes, raw.data(), sizeof(T));
}

// --- text ---

// The whole word as a number that fits T; floats may be "nan" and "inf". None when it is anything else.
template <class T>
std::optional<T> parse_number(std::string_view word) {
  // from_chars knows no plus sign, but printf("%+f") writes one.
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  T value{};
  const char* const end = word.data() + word.size();
  const auto [stop, code] = std::from_chars(word.data(), end, value);
  if (code == std::errc() && stop == end) return value;
  if constexpr (std::is_same_v<T, float>) {
    // A number printed from a double may be too small for a float: that is a zero, not a damaged file.
    if (code == std::errc::result_out_of_range) {
      const auto wide = parse_number<double>(word);
      if (wide && std::abs(*wide) < 1) return static_cast<float>(*wide);
    }
  }
  return std::nullopt;
}

// The shortest text that reads back as the same value (a NaN keeps its sign but not its payload).
template <class T>
void append_number(std::string& text, T value) {
  std::array<char, 32> buffer{};  // the longest double, -2.2250738585072014e-308, has 24 characters
  const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), written.ptr);
}

}  // namespace pointreel::io
