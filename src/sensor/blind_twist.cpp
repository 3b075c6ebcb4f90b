#include "sensor/blind_twist.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "sensor/phase_bank.h"
#include "sensor/row_fit.h"
#include "sensor/twist_equations.h"

namespace pointreel {
namespace {

RowPoints points_of_rows(const TwistSamples& samples, const PolarPoints& polar, std::size_t rows) {
  RowPoints points(rows);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (polar.has_ray(i)) points[samples.row[i]].push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

// Slope and offset of every row from the samples as measured.
void fit_lines(const TwistSamples& samples, const Twist& twist, std::vector<RowModel>& rows) {
  const PolarPoints polar = polar_points(samples.cloud, twist, 1);
  const RowPoints points = points_of_rows(samples, polar, rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const RowFit fit = fit_row(polar, points[r]);
    if (!fit.usable) continue;
    rows[r].slope = fit.slope;
    rows[r].offset_m = fit.offset_m;
  }
}

// The number of ticks that neighbours in a row tell: a fraction, since the yaw stretches all azimuths.
double stretched_ticks_per_turn(const PointCloud& cloud, const RowPoints& rows, const Twist& twist) {
  constexpr std::size_t kMostLag = 5;
  constexpr float kSameM = 3e-4F;  // of 1 / rho: side offsets then move both points alike
  std::vector<double> differences;
  const PolarPoints polar = polar_points(cloud, twist, 1);
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      for (std::size_t lag = 1; lag <= kMostLag && k + lag < row.size(); ++lag) {
        const std::uint32_t a = row[k];
        const std::uint32_t b = row[k + lag];
        if (polar.rho_m[a] < 6 || polar.rho_m[b] < 6) continue;
        if (std::fabs(1 / polar.rho_m[a] - 1 / polar.rho_m[b]) > kSameM) continue;
        const double d =
            static_cast<double>(polar.azimuth_rad[b]) - static_cast<double>(polar.azimuth_rad[a]);
        if (std::fabs(d) > 1e-4 && std::fabs(d) < 0.06) differences.push_back(std::fabs(d));
      }
    }
  }
  if (differences.size() < 500) return 0;
  constexpr std::size_t kMostDifferences = 20000;
  if (differences.size() > kMostDifferences) {
    const std::size_t stride = differences.size() / kMostDifferences + 1;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < differences.size(); k += stride) differences[kept++] = differences[k];
    differences.resize(kept);
  }
  std::vector<double> few;
  for (std::size_t k = 0; k < differences.size(); k += differences.size() / 1500 + 1)
    few.push_back(differences[k]);
  const auto score = [&](double n) {
    double sum = 0;
    for (const double d : differences) sum += std::cos(n * d);
    return sum / static_cast<double>(differences.size());
  };
  constexpr double kFewest = 300;
  constexpr double kStep = 8;
  // Each difference's phase is rotated from one number to the next.
  PhaseBank phases;
  for (const double d : few) phases.add(kFewest * d, kStep * d);
  std::vector<double> scores;
  for (double n = kFewest; n < 12000; n += kStep)
    scores.push_back(static_cast<double>(phases.sum_and_turn().real()) / static_cast<double>(phases.size()));
  const double best = *std::max_element(scores.begin(), scores.end());
  if (best < 0.4) return 0;
  for (std::size_t k = 1; k + 1 < scores.size(); ++k) {
    if (scores[k] < 0.8 * best || scores[k] < scores[k - 1] || scores[k] < scores[k + 1]) continue;
    double n = kFewest + kStep * static_cast<double>(k);
    for (double step = kStep / 2; step > 0.02; step /= 2) {
      const double here = score(n);
      const double up = score(n + step);
      const double down = score(n - step);
      if (up > here && up >= down)
        n += step;
      else if (down > here)
        n -= step;
    }
    return n;
  }
  return 0;
}

// The roundest number within what a sane yaw (0.1 rad a sweep) may have stretched.
std::uint32_t round_ticks(double stretched) {
  const double reach = stretched * 0.1 / kTurn;
  for (const double unit : {1000.0, 900.0, 512.0, 400.0, 360.0, 100.0, 10.0}) {
    const double nearest = std::nearbyint(stretched / unit) * unit;
    if (nearest > 0 && std::fabs(nearest - stretched) <= reach) return static_cast<std::uint32_t>(nearest);
  }
  return static_cast<std::uint32_t>(std::nearbyint(stretched));
}

}  // namespace

std::optional<BlindTwist> find_twist_blind(const PointCloud& cloud, const RowPoints& rows) {
  constexpr std::size_t kSamplesPerRow = 400;
  constexpr int kHeightRounds = 8;
  constexpr int kJointRounds = 5;
  TwistSamples samples;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::size_t stride = rows[r].size() / kSamplesPerRow + 1;
    for (std::size_t k = 0; k < rows[r].size(); k += stride)
      samples.add(cloud.positions[rows[r][k]], static_cast<std::uint32_t>(r));
  }
  if (samples.size() == 0) return {};
  BlindTwist found;
  std::vector<RowModel> lines(rows.size());
  for (int round = 0; round < kHeightRounds; ++round) {
    fit_lines(samples, found.twist, lines);
    found.scatter_m = improve(samples, lines, {0, true}, found.twist).scatter_m;
  }
  const double stretched = stretched_ticks_per_turn(cloud, rows, found.twist);
  if (stretched == 0) return {};
  found.ticks_per_turn = round_ticks(stretched);
  found.twist.w_rad[2] = kTurn * (stretched / found.ticks_per_turn - 1);
  for (int round = 0; round < kJointRounds; ++round) {
    fit_lines(samples, found.twist, lines);
    const PolarPoints polar = polar_points(samples.cloud, found.twist, 1);
    const RowPoints points = points_of_rows(samples, polar, rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const RowAzimuth fit = fit_row_azimuth(polar, points[r], found.ticks_per_turn);
      lines[r].azimuth_rad = fit.phase_rad;
      lines[r].side_offset_m = fit.side_offset_m;
    }
    found.scatter_m = improve(samples, lines, {found.ticks_per_turn, true}, found.twist).scatter_m;
  }
  found.twist = rounded(found.twist);
  return found;
}

}  // namespace pointreel
