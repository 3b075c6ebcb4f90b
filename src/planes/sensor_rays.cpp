#include "planes/sensor_rays.h"

#include <algorithm>
#include <cmath>

#include "base/simd_loops.h"
#include "base/trigonometry.h"

namespace pointreel {
namespace {

POINTREEL_SIMD_LOOPS void met_ranges_m(const SensorRays::RowPlane& plane, const float* cosine,
                                       const float* sine, std::span<float> range_m) {
  constexpr float kLeastM = 1e-3F, kMostM = 2e5F;
  const SensorRays::RowPlane at = plane;
  float* to_m = range_m.data();
  for (std::size_t c = 0, columns = range_m.size(); c < columns; ++c) {
    const float rho_m = at.numerator(cosine[c], sine[c]) / at.denominator(cosine[c], sine[c]);
    const float met_m = rho_m * at.range_per_rho;
    const float in_front_m = met_m > kLeastM ? met_m : kLeastM;  // NaN, too
    to_m[c] = in_front_m < kMostM ? in_front_m : kMostM;
  }
}

}  // namespace

SensorRays::SensorRays(const SensorModel& model, const SweepGrid& grid,
                       std::span<const std::size_t> shift_of_row)
    : columns_(static_cast<int>(grid.column_count())),
      ticks_per_turn_(grid.ticks_per_turn),
      column_tick_(grid.column_tick) {
  const std::size_t columns = grid.column_count();
  cos_.resize(2 * columns + kColumnsMore);
  sin_.resize(2 * columns + kColumnsMore);
  for (std::size_t c = 0; c < columns; ++c) {
    const std::uint32_t tick = grid.column_tick[c] % grid.ticks_per_turn;
    const SinCos azimuth = sin_cos(static_cast<double>(tick) / grid.ticks_per_turn * kTurn);
    for (std::size_t again = c; again < cos_.size(); again += columns) {
      cos_[again] = static_cast<float>(azimuth.cos);
      sin_[again] = static_cast<float>(azimuth.sin);
    }
  }
  rows_.reserve(model.row_count());
  for (std::size_t r = 0; r < model.row_count(); ++r) {
    const RowModel& row = model.rows[r];
    const SinCos alpha = sin_cos(row.azimuth_rad);
    rows_.push_back({row.slope, row.offset_m, row.side_offset_m, alpha.sin, alpha.cos,
                     std::sqrt(1 + row.slope * row.slope), columns - shift_of_row[r],
                     row.azimuth_rad / kTurn});
  }
}

void SensorRays::plane_ranges_m(const Plane& plane, int row, int first, std::span<float> range_m) const {
  met_ranges_m(row_plane(plane, row), cos_of_row(row) + first, sin_of_row(row) + first, range_m);
}

SensorRays::Direction SensorRays::direction(int row, int column) const {
  const Row& r = this->row(row);
  const double cosine = cos_of_row(row)[column], sine = sin_of_row(row)[column];
  return {cosine * r.cos_alpha - sine * r.sin_alpha, sine * r.cos_alpha + cosine * r.sin_alpha, r.slope,
          r.offset_m};
}

std::optional<SensorRays::Cell> SensorRays::cell_towards(double x_m, double y_m, double z_m,
                                                         int from_row) const {
  constexpr double kNearestM = 0.3, kFarthestM = 1e4;
  const double rho_m = std::sqrt(x_m * x_m + y_m * y_m);
  if (!(rho_m > kNearestM && rho_m < kFarthestM)) return std::nullopt;
  const auto height_above = [&](int r) { return z_m - (row(r).slope * rho_m + row(r).offset_m); };
  int nearest = from_row;
  for (const int step : {-1, 1}) {
    for (int next = nearest + step; next >= 0 && next < rows(); next += step) {
      if (!(std::fabs(height_above(next)) < std::fabs(height_above(nearest)))) break;
      nearest = next;
    }
  }
  constexpr double kMostSlopeBeyond = 0.02;
  if (std::fabs(height_above(nearest)) > kMostSlopeBeyond * rho_m) return std::nullopt;
  const Row& at = row(nearest);
  const auto azimuth_rad = static_cast<double>(fast_atan2(static_cast<float>(y_m), static_cast<float>(x_m)));
  double turns = azimuth_rad / kTurn - at.azimuth_turns - at.side_offset_m / (kTurn * rho_m);
  turns -= static_cast<double>(static_cast<std::int64_t>(turns));
  turns += turns < 0 ? 1 : 0;
  turns = turns < 1 ? turns : 0;
  auto tick = static_cast<std::uint32_t>(turns * ticks_per_turn_);
  if (tick < column_tick_.front()) tick += ticks_per_turn_;
  const auto found = std::lower_bound(column_tick_.begin(), column_tick_.end(), tick);
  if (found == column_tick_.end()) return std::nullopt;
  const int column = static_cast<int>(found - column_tick_.begin()) - static_cast<int>(at.first);
  return Cell{nearest, column < 0 ? column + columns_ : column};
}

}  // namespace pointreel
