// PointCloud: positions of one sweep in metres and any number of named scalar fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pointreel {

// Sensor coordinates, metres. x forward, y left, z up in all of Pointreel's own output.
struct Point3f {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Point3f&, const Point3f&) = default;
};

bool is_finite(const Point3f& p);

// One value per point, in the type the input had (std::visit reaches it).
using FieldValues =
    std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                 std::vector<std::uint16_t>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
                 std::vector<std::int64_t>, std::vector<std::uint64_t>, std::vector<float>,
                 std::vector<double>>;

// For example intensity, ring, timestamp. Names are those of the input file.
struct Field {
  std::string name;
  FieldValues values;

  std::size_t size() const;
  friend bool operator==(const Field&, const Field&) = default;
};

// Invariant kept by every reader: each field has exactly positions.size() values.
struct PointCloud {
  std::vector<Point3f> positions;
  std::vector<Field> fields;

  std::size_t size() const { return positions.size(); }
  const Field* find_field(std::string_view name) const;  // nullptr when there is none
  std::size_t count_non_finite() const;                  // points with a NaN or infinite coordinate
};

}  // namespace pointreel
