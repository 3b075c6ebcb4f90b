#include "sensor/row_fit.h"

#include <algorithm>
#include <cmath>

namespace pointreel {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

RowFit fit_row(const PolarPoints& polar, std::span<const std::uint32_t> points) {
  constexpr std::size_t kLeastPoints = 4;
  constexpr int kRounds = 12;
  constexpr double kLeastScaleM = 2e-4;
  RowFit fit;
  if (points.size() < kLeastPoints) return fit;
  std::vector<double> values;
  values.reserve(points.size());
  for (const std::uint32_t i : points) values.push_back(polar.z_m[i] / static_cast<double>(polar.rho_m[i]));
  fit.slope = median(values);
  for (int round = 0; round < kRounds; ++round) {
    values.clear();
    for (const std::uint32_t i : points)
      values.push_back(std::fabs(polar.z_m[i] - fit.slope * polar.rho_m[i] - fit.offset_m));
    fit.scatter_m = median(values);
    // Tukey's weights: what is farther than the limit does not count.
    const double limit = std::max(4.7 * 1.48 * fit.scatter_m, kLeastScaleM * 5);
    double n = 0;
    double sum_r = 0;
    double sum_z = 0;
    double sum_rr = 0;
    double sum_rz = 0;
    for (const std::uint32_t i : points) {
      const double rho = polar.rho_m[i];
      const double z = polar.z_m[i];
      const double t = (z - fit.slope * rho - fit.offset_m) / limit;
      if (std::fabs(t) >= 1) continue;
      const double weight = (1 - t * t) * (1 - t * t);
      n += weight;
      sum_r += weight * rho;
      sum_z += weight * z;
      sum_rr += weight * rho * rho;
      sum_rz += weight * rho * z;
    }
    if (n < 2) return fit;
    const double mean_r = sum_r / n;
    const double mean_z = sum_z / n;
    const RowFit before = fit;
    const double spread = sum_rr / n - mean_r * mean_r;
    // A row that sees everything at one distance keeps its offset.
    if (spread > 1e-4 * mean_r * mean_r)
      fit.slope = (sum_rz / n - mean_r * mean_z) / spread;
    else
      fit.slope = (mean_z - fit.offset_m) / mean_r;
    fit.offset_m = mean_z - fit.slope * mean_r;
    // A thousandth of what the stream can tell apart.
    if (std::fabs(fit.slope - before.slope) < 1e-9 && std::fabs(fit.offset_m - before.offset_m) < 1e-7) break;
  }
  fit.usable = true;
  return fit;
}

}  // namespace pointreel
