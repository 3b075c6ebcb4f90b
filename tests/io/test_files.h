// Files and clouds for the tests of src/io.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "pointreel/io.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace pointreel {

// The bytes of plain values, for building binary bodies by hand.
template <class... T>
std::string bytes_of(T... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
  return bytes;
}

enum class NanPayload : std::uint8_t { exact, any };

template <class T>
bool same_value(T a, T b, NanPayload nan_payload) {
  if constexpr (std::is_floating_point_v<T>) {
    if (nan_payload == NanPayload::any && std::isnan(a) && std::isnan(b)) return true;
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
  } else {
    return a == b;
  }
}

inline bool same_values(const FieldValues& a, const FieldValues& b, NanPayload nan_payload) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        const auto& others = std::get<std::vector<T>>(b);
        return std::equal(values.begin(), values.end(), others.begin(), others.end(),
                          [&](T x, T y) { return same_value(x, y, nan_payload); });
      },
      a);
}

// Bit for bit, as == on floats would take -0 for 0 and no NaN for itself.
inline bool same_cloud(const PointCloud& a, const PointCloud& b, NanPayload nan_payload = NanPayload::exact) {
  const auto same_point = [&](const Point3f& p, const Point3f& q) {
    return same_value(p.x, q.x, nan_payload) && same_value(p.y, q.y, nan_payload) &&
           same_value(p.z, q.z, nan_payload);
  };
  const auto same_field = [&](const Field& f, const Field& g) {
    return f.name == g.name && same_values(f.values, g.values, nan_payload);
  };
  return std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), b.positions.end(),
                    same_point) &&
         std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(), same_field);
}

// The values of a field that must be there and be of type T.
template <class T>
std::vector<T> values_of(const PointCloud& cloud, std::string_view name) {
  const Field* field = cloud.find_field(name);
  const auto* values = field == nullptr ? nullptr : std::get_if<std::vector<T>>(&field->values);
  if (values == nullptr) {
    ADD_FAILURE() << "no field " << name << " of the expected type";
    return {};
  }
  return *values;
}

}  // namespace pointreel
