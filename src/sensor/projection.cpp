#include "sensor/projection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "base/simd_loops.h"
#include "base/trigonometry.h"
#include "sensor/columns.h"
#include "sensor/firing_order.h"
#include "sensor/point_order.h"
#include "sensor/polar_points.h"
#include "sensor/ray_table.h"
#include "sensor/row_assignment.h"
#include "sensor/row_values.h"
#include "sensor/twist_fit.h"

namespace pointreel {
namespace {

void make_stray(GriddedSweep& sweep, std::size_t i, StrayReason reason) {
  sweep.cell_of_point[i] = -1;
  sweep.range_m[i] = 0;
  sweep.deviation_m[i] = 0;
  sweep.stray_reason[i] = reason;
}

// Range along the cell's ray and distance from it.
class Measurement {
 public:
  Measurement(const SensorModel& model, const SweepColumns& columns, double max_deviation_m)
      : columns_(columns),
        most_m_(static_cast<float>(max_deviation_m)),
        slopes_(model, &RowModel::slope),
        offsets_m_(model, &RowModel::offset_m) {
    const double rad_per_tick = kTurn / columns.ticks_per_turn;
    for (const std::uint32_t tick : columns.tick)
      column_rad_.push_back(static_cast<float>(tick * rad_per_tick));
    if (column_rad_.empty()) column_rad_.push_back(0);  // looked at for strays
  }

  // `azimuths_rad`: those of the points' columns (columns.h).
  POINTREEL_SIMD_LOOPS void of_block(const PointCloud& cloud, const PolarPoints& polar,
                                     std::span<const float> azimuths_rad,
                                     const std::vector<std::int16_t>& rows, std::size_t first,
                                     std::size_t count, GriddedSweep& sweep) const {
    // Floats: azimuths are off by less than 2e-6, which is 0.1 mm 50 m away.
    float slope[kBlock], offset_m[kBlock], column_azimuth_rad[kBlock], vertical_m[kBlock], squared_m2[kBlock];
    std::int32_t cell[kBlock];
    const auto column_count = static_cast<std::int32_t>(columns_.tick.size());
    const std::int16_t* row = &rows[first];
    const std::int32_t* column = &columns_.column_of_point[first];
    const RowBlock block(row, count);
    block.spread(slopes_, slope);
    block.spread(offsets_m_, offset_m);
    const float* column_rad = column_rad_.data();
    for (std::size_t k = 0; k < count; ++k) {
      column_azimuth_rad[k] = column_rad[column[k] < 0 ? 0 : column[k]];
      cell[k] = (row[k] | column[k]) < 0 ? -1 : row[k] * column_count + column[k];
    }
    const float* rho_m = &polar.rho_m[first];
    const float* z_m = &polar.z_m[first];
    const float* azimuth_rad = &azimuths_rad[first];
    float* range_m = &sweep.range_m[first];
    float* deviation_m = &sweep.deviation_m[first];
    const float most_m2 = most_m_ * most_m_;
    constexpr auto kTurnF = static_cast<float>(kTurn);
    for (std::size_t k = 0; k < count; ++k) {
      const float above = z_m[k] - offset_m[k];
      const float cosine = 1 / std::sqrt(1 + slope[k] * slope[k]);
      vertical_m[k] = (above - slope[k] * rho_m[k]) * cosine;
      range_m[k] = (rho_m[k] + slope[k] * above) * cosine;
      float turn = azimuth_rad[k] - column_azimuth_rad[k];  // within two turns
      for (int again = 0; again < 2; ++again) {
        turn += turn < -kTurnF / 2 ? kTurnF : 0;
        turn -= turn > kTurnF / 2 ? kTurnF : 0;
      }
      const float across = rho_m[k] * turn;
      squared_m2[k] = across * across + vertical_m[k] * vertical_m[k];
      deviation_m[k] = std::sqrt(squared_m2[k]);
    }
    int strays = 0;
    for (std::size_t k = 0; k < count; ++k)
      strays |= (cell[k] < 0 ? 1 : 0) | (range_m[k] > 0 ? 0 : 1) | (squared_m2[k] > most_m2 ? 1 : 0);
    std::copy_n(cell, count, sweep.cell_of_point.begin() + static_cast<std::ptrdiff_t>(first));
    if (strays == 0) return;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = first + k;
      if (rows[i] < 0) {
        make_stray(sweep, i,
                   polar.has_ray(i)                ? StrayReason::off_row
                   : is_finite(cloud.positions[i]) ? StrayReason::no_ray
                                                   : StrayReason::non_finite);
      } else if (!(range_m[k] > 0) || std::fabs(vertical_m[k]) > most_m_) {
        make_stray(sweep, i, StrayReason::off_row);
      } else if (cell[k] < 0 || squared_m2[k] > most_m2) {
        make_stray(sweep, i, StrayReason::off_column);
      }
    }
  }

  static constexpr std::size_t kBlock = 256;

 private:
  const SweepColumns& columns_;
  float most_m_;
  RowValues slopes_, offsets_m_;
  std::vector<float> column_rad_;
};

void measure(const SensorModel& model, const PointCloud& cloud, const PolarPoints& polar,
             std::span<const float> azimuths_rad, const std::vector<std::int16_t>& rows,
             const SweepColumns& columns, const GridOptions& options, GriddedSweep& sweep) {
  const Measurement measurement(model, columns, options.max_deviation_m);
  for_each_piece(polar.size(), options.threads, [&](std::size_t, std::size_t piece_first, std::size_t last) {
    for (std::size_t first = piece_first; first < last; first += Measurement::kBlock)
      measurement.of_block(cloud, polar, azimuths_rad, rows, first,
                           std::min(Measurement::kBlock, last - first), sweep);
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
  sweep.point_of_cell.assign(cells, kNoPoint);
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    std::uint32_t& holder = sweep.point_of_cell[static_cast<std::size_t>(sweep.cell_of_point[i])];
    if (holder == kNoPoint) {
      holder = static_cast<std::uint32_t>(i);
    } else if (sweep.deviation_m[i] < sweep.deviation_m[holder]) {
      make_stray(sweep, holder, StrayReason::collision);
      holder = static_cast<std::uint32_t>(i);
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
  settle_rows(model, polar, options.threads, rows);
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
  measure(model, cloud, polar, azimuths, rows, columns, options, sweep);
  if (sweep.grid.motion) check_compensation(model, cloud, polar, options, sweep);
  resolve_collisions(model.rows.size() * columns.tick.size(), sweep);
  sweep.grid.order = same_order(previous, sweep.grid, firing_descending)
                         ? previous->order
                         : find_order(model, sweep, firing_descending);
  return sweep;
}

}  // namespace pointreel
