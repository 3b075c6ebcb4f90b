#include "sensor/ray_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/simd_loops.h"
#include "base/trigonometry.h"

namespace pointreel {
namespace {

double column_azimuth_rad(const SweepGrid& grid, std::size_t column) {
  const std::uint32_t tick = grid.column_tick[column] % grid.ticks_per_turn;
  return static_cast<double>(tick) / grid.ticks_per_turn * kTurn;
}

constexpr double kSmallTurnRad = 1;  // turns up to half of this

// Azimuth in (-3 pi, 5 pi) as a part of a turn in (-1/2, 1/2].
inline double turns_from_front(double azimuth_rad) {
  azimuth_rad -= azimuth_rad > kPi ? kTurn : 0.0;
  azimuth_rad -= azimuth_rad > kPi ? kTurn : 0.0;
  azimuth_rad += azimuth_rad <= -kPi ? kTurn : 0.0;
  return azimuth_rad * (1 / kTurn);
}

}  // namespace

RayTable::RayTable(const SensorModel& model, const SweepGrid& grid) {
  rows_.reserve(model.rows.size());
  for (const RowModel& row : model.rows) {
    const SinCos azimuth = sin_cos(row.azimuth_rad);
    const double cos_elevation = 1 / std::sqrt(1 + row.slope * row.slope);
    rows_.push_back({cos_elevation, row.slope, row.offset_m, row.side_offset_m, azimuth.sin, azimuth.cos,
                     row.azimuth_rad, static_cast<float>(cos_elevation),
                     static_cast<float>(row.side_offset_m)});
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

// p = R(-s w) (q - s v), by Rodrigues' formula.
inline RayTable::Vector RayTable::turned_back(const Vector& q, double s, double sine, double versine) const {
  const Vector d = {q.x - s * v_.x, q.y - s * v_.y, q.z - s * v_.z};
  const double along = axis_.x * d.x + axis_.y * d.y + axis_.z * d.z;
  return {d.x + (sine * (axis_.y * d.z - axis_.z * d.y) + versine * (along * axis_.x - d.x)),
          d.y + (sine * (axis_.z * d.x - axis_.x * d.z) + versine * (along * axis_.y - d.y)),
          d.z + (sine * (axis_.x * d.y - axis_.y * d.x) + versine * (along * axis_.z - d.z))};
}

// Sine and cosine by series: below half a radian their error is below 1e-11.
inline RayTable::Vector RayTable::slightly_turned(const Vector& q, double s) const {
  const double t = -s * angle_rad_;
  const double t2 = t * t;
  const double sine =
      t * (1 - t2 * (1.0 / 6) * (1 - t2 * (1.0 / 20) * (1 - t2 * (1.0 / 42) * (1 - t2 * (1.0 / 72)))));
  const double versine = t2 * 0.5 * (1 - t2 * (1.0 / 12) * (1 - t2 * (1.0 / 30) * (1 - t2 * (1.0 / 56))));
  return turned_back(q, s, sine, versine);
}

RayTable::Vector RayTable::compensated(const Vector& q, double azimuth_rad) const {
  const double s = turns_from_front(azimuth_rad);
  if (angle_rad_ < kSmallTurnRad) return slightly_turned(q, s);
  const SinCos turn = sin_cos(-s * angle_rad_);
  return turned_back(q, s, turn.sin, 1 - turn.cos);
}

inline RayTable::Vector RayTable::measured(const Row& row, const Column& column, double range_m) const {
  const double rho = range_m * row.cos_elevation;
  const double sin_a = column.sin * row.cos_azimuth + column.cos * row.sin_azimuth;
  const double cos_a = column.cos * row.cos_azimuth - column.sin * row.sin_azimuth;
  constexpr double kLeastM = 1e-30;  // keeps 0 / 0 away
  // Turned by atan2(h, rho), whose cosine and sine are rho and h over their hypotenuse.
  const double h = row.side_offset_m;
  const double hypotenuse = std::sqrt(rho * rho + h * h);
  const double scale = rho / (hypotenuse > kLeastM ? hypotenuse : kLeastM);
  return {scale * (rho * cos_a - h * sin_a), scale * (rho * sin_a + h * cos_a),
          row.slope * rho + row.offset_m};
}

Point3f RayTable::measured_position(std::size_t row, std::size_t column, float range_m) const {
  const Vector q = measured(rows_[row], columns_[column], range_m);
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}

Point3f RayTable::position(std::size_t row, std::size_t column, float range_m) const {
  const Row& r = rows_[row];
  const Vector q = measured(r, columns_[column], range_m);
  if (!compensated_) return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
  const Vector p =
      compensated(q, columns_[column].azimuth_rad + r.azimuth_rad +
                         static_cast<double>(fast_atan2(r.side_offset_m_f, range_m * r.cos_elevation_f)));
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

struct RayTable::Loops {
  POINTREEL_SIMD_LOOPS static void positions_of_row(const RayTable& table, std::size_t row,
                                                    std::span<const float> range_m,
                                                    std::span<Point3f> positions) {
    const Row r = table.rows_[row];
    constexpr std::size_t kBlock = 64;
    std::array<float, kBlock> side_rad{}, x, y, z;
    for (std::size_t first = 0; first < range_m.size(); first += kBlock) {
      const std::size_t count = std::min(kBlock, range_m.size() - first);
      const float* ranges_m = &range_m[first];
      const Column* columns = &table.columns_[first];
      if (table.compensated_ && table.angle_rad_ >= kSmallTurnRad) {  // no sane sweep
        for (std::size_t k = 0; k < count; ++k)
          positions[first + k] = table.position(row, first + k, ranges_m[k]);
        continue;
      }
      if (table.compensated_) {
        for (std::size_t k = 0; k < count; ++k)
          side_rad[k] = fast_atan2(r.side_offset_m_f, ranges_m[k] * r.cos_elevation_f);
        for (std::size_t k = 0; k < count; ++k) {
          const Vector p = table.slightly_turned(
              table.measured(r, columns[k], ranges_m[k]),
              turns_from_front(columns[k].azimuth_rad + r.azimuth_rad + static_cast<double>(side_rad[k])));
          x[k] = static_cast<float>(p.x);
          y[k] = static_cast<float>(p.y);
          z[k] = static_cast<float>(p.z);
        }
      } else {
        for (std::size_t k = 0; k < count; ++k) {
          const Vector p = table.measured(r, columns[k], ranges_m[k]);
          x[k] = static_cast<float>(p.x);
          y[k] = static_cast<float>(p.y);
          z[k] = static_cast<float>(p.z);
        }
      }
      for (std::size_t k = 0; k < count; ++k) positions[first + k] = {x[k], y[k], z[k]};
    }
  }
};

void RayTable::positions_of_row(std::size_t row, std::span<const float> range_m,
                                std::span<Point3f> positions) const {
  Loops::positions_of_row(*this, row, range_m, positions);
}

std::vector<std::int32_t> column_shift_of_row(const SensorModel& model, const SweepGrid& grid) {
  std::vector<std::int32_t> shifts(model.rows.size(), 0);
  const std::size_t columns = grid.column_count();
  if (columns < 2) return shifts;
  const double ticks = static_cast<double>(grid.column_tick.back() - grid.column_tick.front());
  const double columns_per_turn = static_cast<double>(columns - 1) * grid.ticks_per_turn / ticks;
  const double most = static_cast<double>(columns);
  for (std::size_t r = 0; r < shifts.size(); ++r) {
    const double shift = model.rows[r].azimuth_rad / kTurn * columns_per_turn;
    const double nearest = shift + (shift < 0 ? -0.5 : 0.5);
    shifts[r] = static_cast<std::int32_t>(std::clamp(nearest, -most, most));
  }
  return shifts;
}

}  // namespace pointreel
