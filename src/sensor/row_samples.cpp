#include "sensor/row_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/trigonometry.h"
#include "sensor/polar_points.h"
#include "sensor/row_assignment.h"

namespace pointreel {
namespace {

struct Chosen {
  std::uint32_t point, row, column;
};

// Every point of thin rows, every so many of full ones.
std::vector<Chosen> choose(std::span<const std::uint32_t> point_of_cell, std::size_t columns,
                           const RowsInTurn& turn) {
  constexpr std::size_t kMostPoints = 128;  // of a row, about
  std::vector<Chosen> chosen;
  for (std::size_t row = turn.first; (row + 1) * columns <= point_of_cell.size(); row += turn.step) {
    const auto points = point_of_cell.subspan(row * columns, columns);
    const auto none = static_cast<std::size_t>(std::count(points.begin(), points.end(), kNoPoint));
    const std::size_t left_out = (columns - none) / kMostPoints;
    std::size_t left = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      if (points[column] == kNoPoint || left-- > 0) continue;
      left = left_out;
      chosen.push_back({points[column], static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)});
    }
  }
  return chosen;
}

}  // namespace

RowSamples take_row_samples(const SensorModel& model, const PointCloud& cloud, const GriddedSweep& sweep,
                            const RowsInTurn& turn) {
  constexpr double kLeastRangeM = 1;
  const SweepGrid& grid = sweep.grid;
  RowSamples samples(model.rows.size());
  if (grid.column_count() == 0) return samples;
  const auto all = choose(sweep.point_of_cell, grid.column_count(), turn);
  PointCloud points;
  for (const Chosen& chosen : all) points.positions.push_back(cloud.positions[chosen.point]);
  const PolarPoints polar = polar_points(points, grid.motion, 1);
  const double rad_per_tick = kTurn / grid.ticks_per_turn;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double rho = polar.rho_m[k];
    if (rho < kLeastRangeM) continue;
    const RowModel& row = model.rows[all[k].row];
    const double above = polar.z_m[k] - row.offset_m;
    const double turn_rad = static_cast<double>(polar.azimuth_rad[k]) - row.azimuth_rad -
                            std::atan(row.side_offset_m / rho) -
                            grid.column_tick[all[k].column] * rad_per_tick;
    samples[all[k].row].push_back({rho, (rho + row.slope * above) / std::sqrt(1 + row.slope * row.slope),
                                   height_above_row_m(row, rho, polar.z_m[k]),
                                   turn_rad - kTurn * std::floor(turn_rad / kTurn + 0.5)});
  }
  return samples;
}

}  // namespace pointreel
