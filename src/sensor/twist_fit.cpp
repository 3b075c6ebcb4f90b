#include "sensor/twist_fit.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "sensor/phase_bank.h"
#include "sensor/polar_points.h"
#include "sensor/twist_equations.h"

namespace pointreel {
namespace {

constexpr int kMostRounds = 4;  // of each kind

// Every so many points, by row.
TwistSamples take_samples(const PointCloud& cloud, const std::vector<std::int16_t>& rows) {
  constexpr std::size_t kSamples = 3000;
  const std::size_t stride = cloud.size() / kSamples + 1;
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    if (rows[i] >= 0) chosen.push_back(static_cast<std::uint32_t>(i));
  }
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rows[a] < rows[b]; });
  TwistSamples samples;
  for (const std::uint32_t i : chosen) samples.add(cloud.positions[i], static_cast<std::uint32_t>(rows[i]));
  return samples;
}

// How the points' distances from their ticks agree, over all yaws between two, by rotating each point's phase
// from one yaw to the next.
struct YawPeak {
  double yaw_rad = 0;
  double coherence = 0;  // 1: every point on a tick
};

YawPeak best_yaw(const SensorModel& model, const TwistSamples& samples, const Twist& twist, double from_rad,
                 double to_rad) {
  const PolarPoints polar = polar_points(samples.cloud, twist, 1);
  const double n = model.ticks_per_turn;
  const double step_rad = 1.5 / n;
  PhaseBank phases;
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    const double rho = polar.rho_m[i];
    if (rho < 4) continue;
    const RowModel& row = model.rows[samples.row[i]];
    const double azimuth = polar.azimuth_rad[i];
    const double yaw_rad = twist.w_rad[2] - from_rad;
    const double phase =
        n * (azimuth - row.azimuth_rad - std::atan(row.side_offset_m / rho) - azimuth / kTurn * yaw_rad);
    phases.add(phase, n * azimuth / kTurn * step_rad);
  }
  YawPeak peak{twist.w_rad[2], 0};
  if (phases.size() == 0) return peak;
  float most = -1;
  const int steps = static_cast<int>((to_rad - from_rad) / step_rad);
  for (int k = 0; k <= steps; ++k) {
    const float sum = phases.sum_and_turn().real();
    if (sum > most) {
      most = sum;
      peak = {from_rad + k * step_rad, static_cast<double>(sum) / static_cast<double>(phases.size())};
    }
  }
  return peak;
}

void settle(const TwistSamples& samples, const std::vector<RowModel>& rows, std::uint32_t ticks_per_turn,
            Twist& twist) {
  for (int round = 0; round < kMostRounds; ++round) {
    if (improve(samples, rows, {ticks_per_turn, false}, twist).change < kTwistStep / 2) break;
  }
}

}  // namespace

Twist find_twist(const SensorModel& model, const PointCloud& cloud, const std::vector<std::int16_t>& rows,
                 const std::optional<Twist>& start) {
  constexpr double kMostYaw = 0.2;
  constexpr double kYawChange = 0.03;
  constexpr double kCoherent = 0.5;
  const TwistSamples samples = take_samples(cloud, rows);
  Twist twist;
  if (samples.size() < 50) return twist;
  if (start) {
    twist = *start;
    twist.w_rad[2] = std::clamp(twist.w_rad[2], -kMostYaw, kMostYaw);
  }
  settle(samples, model.rows, 0, twist);
  if (model.ticks_per_turn == 0) return rounded(twist);
  YawPeak peak;
  if (start) {
    const double yaw_rad = twist.w_rad[2];
    peak = best_yaw(model, samples, twist, yaw_rad - kYawChange, yaw_rad + kYawChange);
  }
  if (peak.coherence < kCoherent) peak = best_yaw(model, samples, twist, -kMostYaw, kMostYaw);
  twist.w_rad[2] = peak.yaw_rad;
  settle(samples, model.rows, model.ticks_per_turn, twist);
  return rounded(twist);
}

}  // namespace pointreel
