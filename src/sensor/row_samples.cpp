#include "sensor/row_samples.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "sensor/polar_points.h"
#include "sensor/row_assignment.h"

namespace pointreel {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct Chosen {
  std::uint32_t point, row, column;
};

// Every point of thin rows, every so many of full ones.
std::vector<Chosen> choose(const GriddedSweep& sweep, std::size_t rows, const RowsInTurn& turn) {
  constexpr std::uint32_t kMostPoints = 128;  // of a row, about
  constexpr std::uint32_t kNone = 0xffffffff;
  const auto columns = static_cast<std::uint32_t>(sweep.grid.column_count());
  std::vector<std::uint32_t> points(rows, 0);
  std::vector<std::uint32_t> strides(rows, 0);
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<Chosen> chosen;
    std::vector<std::uint32_t> left(rows, kNone);
    for (std::size_t r = turn.first; r < rows; r += turn.step) left[r] = 0;
    std::uint32_t row = 0;
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
      if (sweep.cell_of_point[i] < 0) continue;
      const auto cell = static_cast<std::uint32_t>(sweep.cell_of_point[i]);
      if (cell < first || cell >= first + columns) {
        row = cell / columns;
        first = row * columns;
      }
      if (pass == 0) {
        ++points[row];
      } else if (left[row]-- == 0) {
        left[row] = strides[row];
        chosen.push_back({static_cast<std::uint32_t>(i), row, cell - first});
      }
    }
    if (pass == 1) return chosen;
    for (std::size_t r = 0; r < rows; ++r) strides[r] = points[r] / kMostPoints;
  }
  return {};
}

}  // namespace

RowSamples take_row_samples(const SensorModel& model, const PointCloud& cloud, const GriddedSweep& sweep,
                            const RowsInTurn& turn) {
  constexpr double kLeastRangeM = 1;
  RowSamples samples(model.rows.size());
  if (sweep.grid.column_count() == 0) return samples;
  const auto all = choose(sweep, model.rows.size(), turn);
  PointCloud points;
  for (const Chosen& chosen : all) points.positions.push_back(cloud.positions[chosen.point]);
  const PolarPoints polar = polar_points(points, sweep.grid.motion, 1);
  const double rad_per_tick = kTurn / sweep.grid.ticks_per_turn;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double rho = polar.rho_m[k];
    if (rho < kLeastRangeM) continue;
    const RowModel& row = model.rows[all[k].row];
    const double above = polar.z_m[k] - row.offset_m;
    const double turn_rad = static_cast<double>(polar.azimuth_rad[k]) - row.azimuth_rad -
                            std::atan(row.side_offset_m / rho) -
                            sweep.grid.column_tick[all[k].column] * rad_per_tick;
    samples[all[k].row].push_back({rho, (rho + row.slope * above) / std::sqrt(1 + row.slope * row.slope),
                                   height_above_row_m(row, rho, polar.z_m[k]),
                                   turn_rad - kTurn * std::floor(turn_rad / kTurn + 0.5)});
  }
  return samples;
}

}  // namespace pointreel
