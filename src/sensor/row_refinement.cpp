#include "sensor/row_refinement.h"

#include <algorithm>
#include <cmath>

namespace pointreel {
namespace {

double median_magnitude(const std::vector<RowSample>& samples, double (*value)(const RowSample&)) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const RowSample& s : samples) values.push_back(std::fabs(value(s)));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Tukey's weight: what is farther than the limit does not count.
double weight_of(double value, double limit) {
  const double t = value / limit;
  return std::fabs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
}

}  // namespace

void RowRefinement::Line::add(double at, double value, double weight) {
  n += weight;
  x += weight * at;
  y += weight * value;
  xx += weight * at * at;
  xy += weight * at * value;
}

std::array<double, 2> RowRefinement::Line::solve() const {
  if (!(n > 0)) return {0, 0};
  const double spread = xx - x * x / n;
  const double rise = spread > 1e-3 * xx ? (xy - x * y / n) / spread : 0;
  return {(y - rise * x) / n, rise};
}

void RowRefinement::add(const RowSamples& samples_of_row) {
  constexpr std::size_t kFewestPoints = 8;
  constexpr double kLeastLimitM = 2e-3;
  constexpr double kFarM = 30;  // farther points weigh no more
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::vector<RowSample>& samples = samples_of_row[r];
    if (samples.size() < kFewestPoints) continue;
    const double height_limit_m =
        std::max(6 * median_magnitude(samples, [](const RowSample& s) { return s.height_m; }), kLeastLimitM);
    const double across_limit_m = std::max(
        6 * median_magnitude(samples, [](const RowSample& s) { return s.turn_rad * s.rho_m; }), kLeastLimitM);
    for (const RowSample& s : samples) {
      rows_[r].height.add(s.rho_m, s.height_m, weight_of(s.height_m, height_limit_m));
      const double lever_m = std::min(s.rho_m, kFarM);
      rows_[r].turn.add(1 / s.rho_m, s.turn_rad,
                        lever_m * lever_m * weight_of(s.turn_rad * s.rho_m, across_limit_m));
    }
  }
}

SensorModel RowRefinement::refined() const {
  SensorModel model = base_;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    RowModel& row = model.rows[r];
    const auto [offset_m, slope] = rows_[r].height.solve();
    const auto [azimuth_rad, side_offset_m] = rows_[r].turn.solve();
    row.offset_m += offset_m;
    row.slope += slope;
    row.azimuth_rad += azimuth_rad;
    row.side_offset_m += side_offset_m;
    row = rounded(row);
  }
  return model;
}

}  // namespace pointreel
