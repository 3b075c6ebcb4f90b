#include "sensor/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "sensor/columns.h"
#include "sensor/firing_order.h"
#include "sensor/point_order.h"
#include "sensor/polar_points.h"
#include "sensor/ray_table.h"
#include "sensor/row_assignment.h"
#include "sensor/twist_fit.h"

namespace pointreel {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

void make_stray(GriddedSweep& sweep, std::size_t i, StrayReason reason) {
  sweep.cell_of_point[i] = -1;
  sweep.range_m[i] = 0;
  sweep.deviation_m[i] = 0;
  sweep.stray_reason[i] = reason;
}

// Range along the cell's ray and distance from it.
void measure(const SensorModel& model, const PointCloud& cloud, const PolarPoints& polar,
             const std::vector<std::int16_t>& rows, const std::vector<double>& azimuths,
             const SweepColumns& columns, const GridOptions& options, GriddedSweep& sweep) {
  const std::size_t count = polar.size();
  const double rad_per_tick = kTurn / columns.ticks_per_turn;
  std::vector<double> column_rad;
  for (const std::uint32_t tick : columns.tick)
    column_rad.push_back(tick % columns.ticks_per_turn * rad_per_tick);
  std::vector<double> cosines;
  for (const RowModel& row : model.rows) cosines.push_back(1 / std::sqrt(1 + row.slope * row.slope));
  const auto column_count = static_cast<std::int32_t>(columns.tick.size());
  const double most_m = options.max_deviation_m;
  parallel_for((count + kPiecePoints - 1) / kPiecePoints, options.threads, [&](std::size_t piece) {
    const std::size_t last = std::min(count, (piece + 1) * kPiecePoints);
    for (std::size_t i = piece * kPiecePoints; i < last; ++i) {
      if (rows[i] < 0) {
        const StrayReason reason = polar.has_ray(i)                ? StrayReason::off_row
                                   : is_finite(cloud.positions[i]) ? StrayReason::no_ray
                                                                   : StrayReason::non_finite;
        make_stray(sweep, i, reason);
        continue;
      }
      const auto r = static_cast<std::size_t>(rows[i]);
      const RowModel& row = model.rows[r];
      const double rho = polar.rho_m[i];
      const double above = polar.z_m[i] - row.offset_m;
      const double range = (rho + row.slope * above) * cosines[r];
      const double vertical = (above - row.slope * rho) * cosines[r];
      if (!(range > 0) || std::fabs(vertical) > most_m) {
        make_stray(sweep, i, StrayReason::off_row);
        continue;
      }
      const std::int32_t column = columns.column_of_point[i];
      if (column < 0) {
        make_stray(sweep, i, StrayReason::off_column);
        continue;
      }
      double turn = azimuths[i] - column_rad[static_cast<std::size_t>(column)];
      if (std::fabs(turn) > 1) turn = std::remainder(turn, kTurn);
      const double across = rho * turn;
      const double squared = across * across + vertical * vertical;
      if (squared > most_m * most_m) {
        make_stray(sweep, i, StrayReason::off_column);
        continue;
      }
      sweep.cell_of_point[i] = rows[i] * column_count + column;
      sweep.range_m[i] = static_cast<float>(range);
      sweep.deviation_m[i] = std::sqrt(static_cast<float>(squared));
    }
  });
}

// Compensated sweeps: whether a point behind the sensor was measured before or after the seam is for its cell
// to say, and the other side is a sweep's motion away. Near the axis, too, the way back may differ.
void check_compensation(const SensorModel& model, const PointCloud& cloud, const PolarPoints& polar,
                        const GridOptions& options, GriddedSweep& sweep) {
  const RayTable rays(model, sweep.grid);
  const std::size_t columns = sweep.grid.column_count();
  const auto& [v, w] = *sweep.grid.motion;
  const auto near_m = static_cast<float>(3 * std::hypot(v[0], v[1], v[2]));
  const auto front_rad = static_cast<float>(kTurn / 2 - 0.01 - 10 * std::hypot(w[0], w[1]));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    if (std::fabs(polar.azimuth_rad[i]) < front_rad && polar.rho_m[i] > near_m) continue;
    const auto cell = static_cast<std::size_t>(sweep.cell_of_point[i]);
    const Point3f p = rays.position(cell / columns, cell % columns, sweep.range_m[i]);
    const Point3f& q = cloud.positions[i];
    const float away = std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
    sweep.deviation_m[i] = away;
    if (static_cast<double>(away) > options.max_deviation_m) make_stray(sweep, i, StrayReason::off_column);
  }
}

// One point per cell: the one that fits best, the first of equals.
void resolve_collisions(std::size_t cells, GriddedSweep& sweep) {
  std::vector<std::int32_t> owner(cells, -1);
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    std::int32_t& holder = owner[static_cast<std::size_t>(sweep.cell_of_point[i])];
    if (holder < 0) {
      holder = static_cast<std::int32_t>(i);
      continue;
    }
    const auto other = static_cast<std::size_t>(holder);
    if (sweep.deviation_m[i] < sweep.deviation_m[other]) {
      make_stray(sweep, other, StrayReason::collision);
      holder = static_cast<std::int32_t>(i);
    } else {
      make_stray(sweep, i, StrayReason::collision);
    }
  }
}

// Sweep by sweep the order is the same.
bool same_order(const SweepGrid* previous, const SweepGrid& grid, std::optional<bool> firing_descending) {
  if (previous == nullptr || previous->order.kind == OrderKind::none) return false;
  if (previous->ticks_per_turn != grid.ticks_per_turn) return false;
  if (is_by_rows(previous->order.kind)) return !firing_descending;
  return firing_descending == previous->order.descending;
}

}  // namespace

GriddedSweep project(const SensorModel& model, const PointCloud& cloud, const GridOptions& options,
                     const SweepGrid* previous) {
  const std::size_t count = cloud.size();
  GriddedSweep sweep;
  sweep.cell_of_point.resize(count);
  sweep.range_m.resize(count);
  sweep.deviation_m.resize(count);
  sweep.stray_reason.assign(count, StrayReason::none);

  PolarPoints polar = polar_points(cloud, {}, options.threads);
  auto rows = assign_rows(model, cloud, polar, options.threads);
  if (model.motion_compensated) {
    sweep.grid.motion = find_twist(model, cloud, rows, previous != nullptr ? previous->motion : std::nullopt);
    polar = polar_points(cloud, sweep.grid.motion, options.threads);
  }
  settle_rows(model, polar, rows);
  auto azimuths = column_azimuths(model, polar, rows, options.threads);
  std::optional<bool> firing_descending;
  if (auto firing = find_firing_order(azimuths, rows)) {
    firing_descending = firing->descending;
    azimuths = std::move(firing->azimuth_rad);
  }
  const SweepColumns columns =
      find_columns(model, polar, rows, azimuths, firing_descending.has_value(), options);
  sweep.grid.ticks_per_turn = columns.ticks_per_turn;
  sweep.grid.column_tick = columns.tick;
  measure(model, cloud, polar, rows, azimuths, columns, options, sweep);
  if (sweep.grid.motion) check_compensation(model, cloud, polar, options, sweep);
  resolve_collisions(model.rows.size() * columns.tick.size(), sweep);
  sweep.grid.order = same_order(previous, sweep.grid, firing_descending)
                         ? previous->order
                         : find_order(model, sweep, firing_descending);
  return sweep;
}

}  // namespace pointreel
