// Sensor grids and field values for the tests of field coding.
#pragma once

#include <bit>
#include <cstring>
#include <random>

#include "fields/field_coding.h"

namespace pointreel {

// A grid with holes, two points off it, and one cell with two points; the points come column by column.
struct SampleGrid {
  std::uint32_t rows = 0, columns = 0;
  std::vector<std::int32_t> cell_of_point;
  std::vector<float> range_m;

  SampleGrid(std::uint32_t rows_, std::uint32_t columns_, unsigned seed = 1)
      : rows(rows_), columns(columns_) {
    std::mt19937 random(seed);
    const auto add = [&](std::int32_t cell) {
      cell_of_point.push_back(cell);
      range_m.push_back(static_cast<float>(random() % 8000) / 100);
    };
    for (std::uint32_t column = 0; column < columns; ++column) {
      for (std::uint32_t row = 0; row < rows; ++row) {
        const auto cell = static_cast<std::int32_t>(row * columns + column);
        if (random() % 8 != 0) add(cell);
        if (cell == 3) add(cell);
        if (cell % 50 == 49) add(-1);
      }
    }
  }
  std::size_t size() const { return cell_of_point.size(); }
  PointLayout layout() const { return PointLayout({rows, columns, cell_of_point, range_m}); }
};

// Bits, so that NaNs and signed zeros count.
inline bool same_bits(const FieldValues& a, const FieldValues& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        const auto& others = std::get<std::vector<T>>(b);
        return values.size() == others.size() &&
               (values.empty() || std::memcmp(values.data(), others.data(), values.size() * sizeof(T)) == 0);
      },
      a);
}

template <class T>
T any_bits(std::mt19937_64& random) {
  T value;
  const std::uint64_t bits = random();
  std::memcpy(&value, &bits, sizeof(T));
  return value;
}

}  // namespace pointreel
