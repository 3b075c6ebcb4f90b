#include "fields/point_layout.h"

#include <algorithm>

namespace pointreel {

PointLayout::PointLayout(const FieldContext& context)
    : rows_(context.rows + 1),
      columns_(std::max(context.columns, 1u)),
      places_(context.cell_of_point.size()) {
  const std::uint64_t cells = std::uint64_t{context.rows} * context.columns;
  const auto place_of = [&](std::size_t point) {
    const std::int32_t cell = context.cell_of_point[point];
    const bool in_grid = cell >= 0 && static_cast<std::uint64_t>(cell) < cells;
    const std::uint32_t index = static_cast<std::uint32_t>(cell);
    return Place{static_cast<std::uint32_t>(point), in_grid ? index / columns_ : context.rows,
                 in_grid ? index % columns_ : 0u, context.range_m[point]};
  };

  // Sorted by row by counting; within a row the points mostly come in order already.
  std::vector<std::size_t> first_of_row(rows_ + 1, 0);
  for (std::size_t i = 0; i < places_.size(); ++i) ++first_of_row[place_of(i).row + 1];
  for (std::size_t row = 0; row < rows_; ++row) first_of_row[row + 1] += first_of_row[row];
  std::vector<std::size_t> next = first_of_row;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place place = place_of(i);
    places_[next[place.row]++] = place;
  }
  for (std::size_t row = 0; row < rows_; ++row) {
    const auto begin = places_.begin() + static_cast<std::ptrdiff_t>(first_of_row[row]);
    const auto end = places_.begin() + static_cast<std::ptrdiff_t>(first_of_row[row + 1]);
    const auto by_column = [](const Place& a, const Place& b) { return a.column < b.column; };
    if (!std::is_sorted(begin, end, by_column)) std::stable_sort(begin, end, by_column);
  }
}

}  // namespace pointreel
