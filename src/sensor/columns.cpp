#include "sensor/columns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace pointreel {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// A tick that fewer rows use is no column: its points are sent apart, which is cheaper than a column.
std::uint32_t least_support(std::size_t rows) {
  return rows >= 16 ? 3 : rows >= 4 ? 2 : 1;
}

SweepColumns columns_on_lattice(const SensorModel& model, const PolarPoints& polar,
                                const std::vector<std::int16_t>& rows,
                                const std::vector<double>& column_azimuth_rad, const GridOptions& options) {
  const std::uint32_t turn = model.ticks_per_turn;
  const double ticks_per_rad = turn / kTurn;
  SweepColumns columns{turn, {}, std::vector<std::int32_t>(polar.size(), -1)};
  std::vector<std::uint32_t> support(turn, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) continue;
    auto tick = static_cast<std::uint32_t>(column_azimuth_rad[i] * ticks_per_rad + 0.5);
    if (tick >= turn) tick -= turn;
    columns.column_of_point[i] = static_cast<std::int32_t>(tick);
    ++support[tick];
  }
  const std::uint32_t least = least_support(model.rows.size());
  std::vector<std::int32_t> column_of_tick(turn, -1);
  for (std::uint32_t tick = 0; tick < turn; ++tick) {
    if (support[tick] < least) continue;
    column_of_tick[tick] = static_cast<std::int32_t>(columns.tick.size());
    columns.tick.push_back(tick);
  }
  // Points between the columns go to a neighbour that is near enough: close to the sensor, where the file's
  // rounding turns them by more than half a tick.
  const double near_m = std::min(options.max_deviation_m, options.max_error_m / 4);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) continue;
    const auto tick = static_cast<std::uint32_t>(columns.column_of_point[i]);
    std::int32_t column = column_of_tick[tick];
    if (column < 0) {
      double nearest_m = near_m;
      for (const std::uint32_t other : {tick + 1 == turn ? 0 : tick + 1, tick == 0 ? turn - 1 : tick - 1}) {
        if (column_of_tick[other] < 0) continue;
        const double away = std::remainder(column_azimuth_rad[i] - other / ticks_per_rad, kTurn);
        if (std::fabs(away) * polar.rho_m[i] >= nearest_m) continue;
        nearest_m = std::fabs(away) * polar.rho_m[i];
        column = column_of_tick[other];
      }
    }
    columns.column_of_point[i] = column;
  }
  return columns;
}

}  // namespace

std::vector<double> column_azimuths(const SensorModel& model, const PolarPoints& polar,
                                    const std::vector<std::int16_t>& rows, int threads) {
  std::vector<double> azimuths(polar.size());
  parallel_for((polar.size() + kPiecePoints - 1) / kPiecePoints, threads, [&](std::size_t piece) {
    const std::size_t last = std::min(polar.size(), (piece + 1) * kPiecePoints);
    for (std::size_t i = piece * kPiecePoints; i < last; ++i) {
      if (rows[i] < 0) continue;
      const RowModel& row = model.rows[static_cast<std::size_t>(rows[i])];
      const double t = row.side_offset_m / static_cast<double>(polar.rho_m[i]);
      const double turned = std::fabs(t) < 0.05 ? t - t * t * t / 3 : std::atan(t);
      double azimuth = static_cast<double>(polar.azimuth_rad[i]) - row.azimuth_rad - turned;
      while (azimuth < 0) azimuth += kTurn;
      while (azimuth >= kTurn) azimuth -= kTurn;
      azimuths[i] = azimuth;
    }
  });
  return azimuths;
}

SweepColumns find_columns(const SensorModel& model, const PolarPoints& polar,
                          const std::vector<std::int16_t>& rows,
                          const std::vector<double>& column_azimuth_rad, const GridOptions& options) {
  return columns_on_lattice(model, polar, rows, column_azimuth_rad, options);
}

}  // namespace pointreel
