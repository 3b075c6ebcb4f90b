#include "sensor/row_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sensor/row_assignment.h"
#include "sensor/row_fit.h"
#include "sensor/row_runs.h"

namespace pointreel {
namespace {

constexpr std::size_t kShortRow = 12;

RowEvidence rows_from_rings(const std::vector<std::int32_t>& rings, const PolarPoints& polar) {
  std::vector<std::int32_t> values = rings;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 2 || values.size() > kMaxRows) return {};
  RowPoints points(values.size());
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const auto found = std::lower_bound(values.begin(), values.end(), rings[i]);
    points[static_cast<std::size_t>(found - values.begin())].push_back(static_cast<std::uint32_t>(i));
  }
  RowEvidence evidence;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (points[k].size() < 4) continue;
    evidence.points.push_back(std::move(points[k]));
    evidence.ring.push_back(values[k]);
  }
  return evidence;
}

RowEvidence rows_from_runs(const PolarPoints& polar) {
  const RowRuns runs = split_into_runs(polar);
  if (runs.runs() < 2 || runs.runs() > 2 * kMaxRows) return {};
  RowEvidence evidence;
  for (std::size_t run = 0; run < runs.runs(); ++run) {
    std::vector<std::uint32_t> points;
    for (std::size_t i = runs.first[run]; i < runs.end(run, polar.size()); ++i) {
      if (polar.has_ray(i)) points.push_back(static_cast<std::uint32_t>(i));
    }
    if (points.size() >= kShortRow) evidence.points.push_back(std::move(points));
  }
  if (evidence.points.size() > kMaxRows) return {};
  return evidence;
}

// Histogram of elevations seen from somewhere on the axis.
struct ElevationBins {
  static constexpr std::size_t kBins = 6000;
  static constexpr double kWidth = std::numbers::pi / kBins;
  static std::size_t bin(double elevation) {
    return std::min(kBins - 1, static_cast<std::size_t>((elevation + std::numbers::pi / 2) / kWidth));
  }
  std::vector<std::uint32_t> points = std::vector<std::uint32_t>(kBins, 0);
  double sharpness() const {
    double sum = 0;
    for (const std::uint32_t n : points) sum += static_cast<double>(n) * n;
    return sum;
  }
};

// Peaks of elevation, each made a row by a line through it, and all points then given to the nearest line.
RowEvidence rows_from_elevations(const PolarPoints& polar) {
  constexpr float kNearM = 2;
  constexpr std::size_t kSamples = 40000;
  const std::size_t stride = polar.size() / kSamples + 1;
  ElevationBins sharpest;
  double best = -1;
  double origin_m = 0;
  for (int k = -15; k <= 15; ++k) {
    const double candidate_m = k * 0.02;
    ElevationBins bins;
    for (std::size_t i = 0; i < polar.size(); i += stride) {
      if (polar.rho_m[i] >= kNearM)
        ++bins.points[ElevationBins::bin(
            std::atan2(polar.z_m[i] - candidate_m, static_cast<double>(polar.rho_m[i])))];
    }
    const double sharpness = bins.sharpness() * (k == 0 ? 1.05 : 1.0);
    if (sharpness <= best) continue;
    best = sharpness;
    origin_m = candidate_m;
    sharpest = std::move(bins);
  }
  // Peaks: bins that hold more than the mean of their surroundings, merged when adjacent.
  std::vector<double> centres;
  constexpr std::size_t kAround = 12;
  double sum = 0;
  double weight = 0;
  for (std::size_t b = 0; b < ElevationBins::kBins; ++b) {
    double around = 0;
    const std::size_t first = b < kAround ? 0 : b - kAround;
    const std::size_t last = std::min(ElevationBins::kBins, b + kAround + 1);
    for (std::size_t k = first; k < last; ++k) around += sharpest.points[k];
    const double mean = around / static_cast<double>(last - first);
    const double here = sharpest.points[b];
    if (here >= 4 && here > 1.3 * mean) {
      sum += here * (static_cast<double>(b) + 0.5);
      weight += here;
    } else if (weight > 0) {
      if (weight >= kShortRow) centres.push_back(sum / weight * ElevationBins::kWidth - std::numbers::pi / 2);
      sum = weight = 0;
    }
  }
  if (centres.size() < 2 || centres.size() > kMaxRows) return {};

  SensorModel lines;
  for (auto centre = centres.rbegin(); centre != centres.rend(); ++centre)
    lines.rows.push_back({std::tan(*centre), origin_m, 0, 0});
  RowEvidence evidence;
  for (int round = 0; round < 4; ++round) {
    const auto rows = nearest_rows(lines, polar);
    evidence.points.assign(lines.rows.size(), {});
    for (std::size_t i = 0; i < polar.size(); ++i) {
      if (rows[i] < 0 || (round == 0 && polar.rho_m[i] < kNearM)) continue;
      evidence.points[static_cast<std::size_t>(rows[i])].push_back(static_cast<std::uint32_t>(i));
    }
    if (round == 3) break;
    std::vector<double> scatters_m;
    std::vector<std::size_t> counts;
    for (std::size_t r = 0; r < lines.rows.size(); ++r) {
      const RowFit fit = fit_row(polar, evidence.points[r]);
      if (fit.usable && std::fabs(fit.offset_m) < 0.5) {
        lines.rows[r].slope = fit.slope;
        lines.rows[r].offset_m = fit.offset_m;
      }
      scatters_m.push_back(fit.usable ? fit.scatter_m : 1.0);
      counts.push_back(evidence.points[r].size());
    }
    // What is no laser, but a wall or the ground between two, has few points or scatters.
    auto sorted_scatters = scatters_m;
    auto sorted_counts = counts;
    std::sort(sorted_scatters.begin(), sorted_scatters.end());
    std::sort(sorted_counts.begin(), sorted_counts.end());
    const double most_m = std::max(0.005, 8 * sorted_scatters[sorted_scatters.size() / 2]);
    const std::size_t fewest = sorted_counts[sorted_counts.size() / 2] / 5;
    SensorModel kept;
    for (std::size_t r = 0; r < lines.rows.size(); ++r) {
      if (scatters_m[r] <= most_m && counts[r] >= fewest) kept.rows.push_back(lines.rows[r]);
    }
    if (kept.rows.size() < 2) return {};
    lines = std::move(kept);
    std::sort(lines.rows.begin(), lines.rows.end(),
              [](const RowModel& a, const RowModel& b) { return a.slope > b.slope; });
  }
  std::erase_if(evidence.points, [](const auto& points) { return points.size() < kShortRow; });
  return evidence;
}

}  // namespace

RowEvidence find_row_evidence(EvidenceKind kind, const PointCloud& cloud, const PolarPoints& polar) {
  switch (kind) {
    case EvidenceKind::ring: {
      const auto rings = ring_values(cloud);
      return rings.empty() ? RowEvidence{} : rows_from_rings(rings, polar);
    }
    case EvidenceKind::runs:
      return rows_from_runs(polar);
    case EvidenceKind::elevations:
      return rows_from_elevations(polar);
  }
  return {};
}

}  // namespace pointreel
