#include "motion/range_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pointreel {
namespace {

// Each empty (-1) entry takes the value of the nearest full one, around the ring.
void fill_from_nearest(std::vector<std::int32_t>& ring) {
  const auto first = std::find_if(ring.begin(), ring.end(), [](std::int32_t v) { return v >= 0; });
  if (first == ring.end()) return;
  std::rotate(ring.begin(), first, ring.end());
  for (std::size_t begin = 0; begin < ring.size();) {
    std::size_t end = begin + 1;
    while (end < ring.size() && ring[end] < 0) ++end;
    const std::size_t middle = begin + (end - begin) / 2;
    const std::int32_t after = ring[end < ring.size() ? end : 0];
    for (std::size_t i = begin + 1; i < end; ++i) ring[i] = i <= middle ? ring[begin] : after;
    begin = end;
  }
  std::rotate(ring.begin(), ring.end() - (first - ring.begin()), ring.end());
}

// Columns may go either way around, more than once, or leave a part out.
double columns_per_rad(std::span<const double> column_azimuth_rad) {
  double covered_rad = 0;
  for (std::size_t c = 1; c < column_azimuth_rad.size(); ++c) {
    covered_rad += std::remainder(column_azimuth_rad[c] - column_azimuth_rad[c - 1], kTurn);
  }
  return std::fabs(covered_rad) > 1e-6 ? static_cast<double>(column_azimuth_rad.size() - 1) / covered_rad : 0;
}

}  // namespace

GridRays::GridRays(const RangeGrid& grid) : range_m_(grid.range_m) {
  const std::size_t columns = grid.column_azimuth_rad.size();
  if (columns == 0 || grid.range_m.size() != grid.rows.size() * columns) return;
  const double columns_ahead_per_rad = columns_per_rad(grid.column_azimuth_rad);
  double lowest = grid.rows[0].slope, highest = lowest, offsets_m = 0;
  for (const GridRow& row : grid.rows) {
    const auto turned_by = static_cast<int>(std::llrint(row.azimuth_rad * columns_ahead_per_rad) %
                                            static_cast<std::int64_t>(columns));
    rows_.push_back(
        {static_cast<float>(row.slope), static_cast<float>(row.offset_m), static_cast<float>(row.azimuth_rad),
         static_cast<float>(row.side_offset_m), static_cast<float>(1 / std::sqrt(1 + row.slope * row.slope)),
         static_cast<float>(std::cos(row.azimuth_rad)), static_cast<float>(std::sin(row.azimuth_rad)),
         turned_by < 0 ? turned_by + static_cast<int>(columns) : turned_by});
    lowest = std::min(lowest, row.slope);
    highest = std::max(highest, row.slope);
    offsets_m += row.offset_m;
  }
  directions_.mean_offset_m = static_cast<float>(offsets_m / static_cast<double>(rows_.size()));

  const std::size_t bins = std::bit_ceil(4 * columns);
  directions_.bins_per_rad = static_cast<float>(static_cast<double>(bins) / kTurn);
  directions_.column_of_bin.assign(bins, -1);
  cos_azimuth_.reserve(columns);
  sin_azimuth_.reserve(columns);
  for (std::size_t c = 0; c < columns; ++c) {
    const double azimuth_rad = grid.column_azimuth_rad[c];
    cos_azimuth_.push_back(static_cast<float>(std::cos(azimuth_rad)));
    sin_azimuth_.push_back(static_cast<float>(std::sin(azimuth_rad)));
    const auto bin =
        static_cast<std::uint64_t>(std::llrint(azimuth_rad * static_cast<double>(directions_.bins_per_rad)));
    directions_.column_of_bin[bin & (bins - 1)] = static_cast<std::int32_t>(c);
  }
  fill_from_nearest(directions_.column_of_bin);

  // Rows go from top to bottom, bins of slope from bottom to top.
  directions_.row_of_bin.resize(16 * rows_.size());
  directions_.lowest_slope = static_cast<float>(lowest);
  const double step = std::max(highest - lowest, 1e-3) / static_cast<double>(directions_.row_of_bin.size());
  directions_.bins_per_slope = static_cast<float>(1 / step);
  int row = row_count() - 1;
  const auto away = [&](int r, double slope) {
    return std::fabs(grid.rows[static_cast<std::size_t>(r)].slope - slope);
  };
  for (std::size_t bin = 0; bin < directions_.row_of_bin.size(); ++bin) {
    const double slope = lowest + (static_cast<double>(bin) + 0.5) * step;
    while (row > 0 && away(row - 1, slope) <= away(row, slope)) --row;
    directions_.row_of_bin[bin] = row;
  }
}

}  // namespace pointreel
