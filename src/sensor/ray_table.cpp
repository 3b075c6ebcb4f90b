#include "sensor/ray_table.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"

namespace pointreel {
namespace {

double column_azimuth_rad(const SweepGrid& grid, std::size_t column) {
  const std::uint32_t tick = grid.column_tick[column] % grid.ticks_per_turn;
  return static_cast<double>(tick) / grid.ticks_per_turn * (2 * kPi);
}

}  // namespace

RayTable::RayTable(const SensorModel& model, const SweepGrid& grid) {
  rows_.reserve(model.rows.size());
  for (const RowModel& row : model.rows) {
    const SinCos azimuth = sin_cos(row.azimuth_rad);
    rows_.push_back({1 / std::sqrt(1 + row.slope * row.slope), row.slope, row.offset_m, row.side_offset_m,
                     azimuth.sin, azimuth.cos, row.azimuth_rad});
  }
  columns_.reserve(grid.column_count());
  for (std::size_t c = 0; c < grid.column_count(); ++c) {
    const double azimuth_rad = column_azimuth_rad(grid, c);
    const SinCos azimuth = sin_cos(azimuth_rad);
    columns_.push_back({azimuth.sin, azimuth.cos, azimuth_rad});
  }
  if (!grid.motion) return;
  compensated_ = true;
  const auto& [v, w] = *grid.motion;
  v_ = {v[0], v[1], v[2]};
  angle_rad_ = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (angle_rad_ > 0) axis_ = {w[0] / angle_rad_, w[1] / angle_rad_, w[2] / angle_rad_};
}

RayTable::Vector RayTable::measured(const Row& row, const Column& column, double range_m) const {
  const double rho = range_m * row.cos_elevation;
  const double sin_a = column.sin * row.cos_azimuth + column.cos * row.sin_azimuth;
  const double cos_a = column.cos * row.cos_azimuth - column.sin * row.sin_azimuth;
  // Turned by atan2(h, rho), whose cosine and sine are rho and h over their hypotenuse.
  const double h = row.side_offset_m;
  const double hypotenuse = std::sqrt(rho * rho + h * h);
  const double scale = hypotenuse > 0 ? rho / hypotenuse : 0.0;
  return {scale * (rho * cos_a - h * sin_a), scale * (rho * sin_a + h * cos_a),
          row.slope * rho + row.offset_m};
}

Point3f RayTable::measured_position(std::size_t row, std::size_t column, float range_m) const {
  const Vector q = measured(rows_[row], columns_[column], range_m);
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}

Point3f RayTable::position(std::size_t row, std::size_t column, float range_m) const {
  const Row& r = rows_[row];
  const Column& c = columns_[column];
  const Vector q = measured(r, c, range_m);
  if (!compensated_) return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};

  double azimuth_rad = c.azimuth_rad + r.azimuth_rad;
  azimuth_rad += static_cast<double>(
      fast_atan2(static_cast<float>(r.side_offset_m), static_cast<float>(range_m * r.cos_elevation)));
  while (azimuth_rad > kPi) azimuth_rad -= 2 * kPi;
  while (azimuth_rad <= -kPi) azimuth_rad += 2 * kPi;
  const double s = azimuth_rad / (2 * kPi);
  // p = R(-s w) (q - s v), by Rodrigues' formula.
  const Vector d = {q.x - s * v_.x, q.y - s * v_.y, q.z - s * v_.z};
  const SinCos turn = sin_cos(-s * angle_rad_);
  const double along = (axis_.x * d.x + axis_.y * d.y + axis_.z * d.z) * (1 - turn.cos);
  return {static_cast<float>(turn.cos * d.x + turn.sin * (axis_.y * d.z - axis_.z * d.y) + along * axis_.x),
          static_cast<float>(turn.cos * d.y + turn.sin * (axis_.z * d.x - axis_.x * d.z) + along * axis_.y),
          static_cast<float>(turn.cos * d.z + turn.sin * (axis_.x * d.y - axis_.y * d.x) + along * axis_.z)};
}

std::vector<std::int32_t> column_shift_of_row(const SensorModel& model, const SweepGrid& grid) {
  std::vector<std::int32_t> shifts(model.rows.size(), 0);
  const std::size_t columns = grid.column_count();
  if (columns < 2) return shifts;
  const double ticks = static_cast<double>(grid.column_tick.back() - grid.column_tick.front());
  const double columns_per_turn = static_cast<double>(columns - 1) * grid.ticks_per_turn / ticks;
  const double most = static_cast<double>(columns);
  for (std::size_t r = 0; r < shifts.size(); ++r) {
    const double shift = model.rows[r].azimuth_rad / (2 * kPi) * columns_per_turn;
    const double nearest = shift + (shift < 0 ? -0.5 : 0.5);
    shifts[r] = static_cast<std::int32_t>(std::clamp(nearest, -most, most));
  }
  return shifts;
}

}  // namespace pointreel
