#include "sensor/sensor_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/parallel.h"
#include "sensor/polar_points.h"
#include "sensor/row_assignment.h"
#include "sensor/row_fit.h"
#include "sensor/row_runs.h"
#include "sensor/tick_lattice.h"
#include "sensor/twist_fit.h"

namespace pointreel {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Rows of a compensated sweep are this sharp once the motion is put back, or there was none.
constexpr double kCompensatedScatterM = 3e-3;

// Groups of points that one laser measured, in the order in which they first come.
struct RowEvidence {
  RowPoints points;
  std::vector<std::int32_t> ring;  // of each group; empty without a ring field
};

RowEvidence rows_from_rings(const std::vector<std::int32_t>& rings, const PolarPoints& polar) {
  RowEvidence evidence;
  std::vector<std::int32_t> values = rings;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 2 || values.size() > kMaxRows) return {};
  evidence.ring = values;
  evidence.points.resize(values.size());
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const auto found = std::lower_bound(values.begin(), values.end(), rings[i]);
    evidence.points[static_cast<std::size_t>(found - values.begin())].push_back(
        static_cast<std::uint32_t>(i));
  }
  return evidence;
}

RowEvidence rows_from_runs(const PolarPoints& polar) {
  constexpr std::size_t kShortRun = 24;
  const RowRuns runs = split_into_runs(polar);
  if (runs.runs() < 2 || runs.runs() > 2 * kMaxRows) return {};
  RowEvidence evidence;
  for (std::size_t run = 0; run < runs.runs(); ++run) {
    std::vector<std::uint32_t> points;
    for (std::size_t i = runs.first[run]; i < runs.end(run, polar.size()); ++i) {
      if (polar.has_ray(i)) points.push_back(static_cast<std::uint32_t>(i));
    }
    if (points.size() >= kShortRun) evidence.points.push_back(std::move(points));
  }
  if (evidence.points.size() > kMaxRows) return {};
  return evidence;
}

// The model's rows from evidence: lines, ticks, side offsets, azimuths.
std::optional<SensorModel> model_of(const PolarPoints& polar, const RowEvidence& evidence, int threads) {
  const std::size_t groups = evidence.points.size();
  if (groups == 0) return {};
  std::vector<RowFit> fits(groups);
  parallel_for(groups, threads, [&](std::size_t g) { fits[g] = fit_row(polar, evidence.points[g]); });
  // Top to bottom by the elevation far away.
  std::vector<std::size_t> group_of_row;
  for (std::size_t g = 0; g < groups; ++g) {
    if (fits[g].usable) group_of_row.push_back(g);
  }
  if (group_of_row.empty()) return {};
  std::stable_sort(group_of_row.begin(), group_of_row.end(),
                   [&](std::size_t a, std::size_t b) { return fits[a].slope > fits[b].slope; });
  const std::size_t rows = group_of_row.size();
  RowPoints points(rows);
  SensorModel model;
  model.rows.resize(rows);
  model.row_sequence.resize(rows);
  std::vector<std::size_t> by_group(rows);
  std::iota(by_group.begin(), by_group.end(), std::size_t{0});
  std::sort(by_group.begin(), by_group.end(),
            [&](std::size_t a, std::size_t b) { return group_of_row[a] < group_of_row[b]; });
  for (std::size_t i = 0; i < rows; ++i) model.row_sequence[i] = static_cast<std::uint16_t>(by_group[i]);
  for (std::size_t r = 0; r < rows; ++r) {
    const std::size_t g = group_of_row[r];
    model.rows[r].slope = fits[g].slope;
    model.rows[r].offset_m = fits[g].offset_m;
    points[r] = evidence.points[g];
    if (!evidence.ring.empty()) model.ring_of_row.push_back(evidence.ring[g]);
  }
  model.ticks_per_turn = find_ticks_per_turn(polar, points);
  if (model.ticks_per_turn == 0) return {};
  const double tick_rad = kTurn / model.ticks_per_turn;
  std::vector<std::vector<std::uint32_t>> ticks(rows);
  parallel_for(rows, threads, [&](std::size_t r) {
    const RowAzimuth fit = fit_row_azimuth(polar, points[r], model.ticks_per_turn);
    RowModel& row = model.rows[r];
    row.side_offset_m = fit.side_offset_m;
    row.azimuth_rad = fit.phase_rad;
    for (const std::uint32_t i : points[r]) {
      double azimuth = static_cast<double>(polar.azimuth_rad[i]) - row.azimuth_rad -
                       std::atan(row.side_offset_m / static_cast<double>(polar.rho_m[i]));
      azimuth -= kTurn * std::floor(azimuth / kTurn);
      ticks[r].push_back(static_cast<std::uint32_t>(azimuth / tick_rad + 0.5) % model.ticks_per_turn);
    }
  });
  const auto shifts = align_rows(ticks, model.ticks_per_turn);
  for (std::size_t r = 0; r < rows; ++r) {
    model.rows[r].azimuth_rad -= shifts[r] * tick_rad;
    model.rows[r] = rounded(model.rows[r]);
  }
  return model;
}

}  // namespace

void SensorEstimator::add(const PointCloud& cloud) {
  ++sweeps_;
  if (model_) return;
  const PolarPoints polar = polar_points(cloud, {}, options_.threads);
  const auto rings = ring_values(cloud);
  RowEvidence evidence;
  if (!rings.empty()) evidence = rows_from_rings(rings, polar);
  if (evidence.points.empty()) evidence = rows_from_runs(polar);
  model_ = model_of(polar, evidence, options_.threads);
  if (model_ || evidence.points.empty()) return;
  const auto blind = find_twist_blind(cloud, evidence.points);
  if (!blind || blind->scatter_m > kCompensatedScatterM) return;
  const PolarPoints measured = polar_points(cloud, blind->twist, options_.threads);
  model_ = model_of(measured, evidence, options_.threads);
  if (model_) model_->motion_compensated = true;
}

}  // namespace pointreel
