#include "sensor/row_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pointreel {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

// A seam at azimuth 0, or behind the sensor.
RowRuns split(const PolarPoints& polar, bool behind) {
  const auto turned = [&](std::size_t i) {
    const float a = polar.azimuth_rad[i];
    return a < 0 && !behind ? a + kTurn : a;
  };
  // Which way the sensor turns: the sign of most small steps.
  std::size_t up = 0;
  std::size_t down = 0;
  float before = 0;
  bool any = false;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const float a = turned(i);
    if (any && a > before && a - before < 0.1F) ++up;
    if (any && a < before && before - a < 0.1F) ++down;
    before = a;
    any = true;
  }
  RowRuns runs;
  runs.descending = down > up;
  any = false;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const float a = turned(i);
    const float back = runs.descending ? a - before : before - a;
    if (!any) {
      runs.first.push_back(0);
    } else if (back > 1) {
      runs.first.push_back(i);
    }
    before = a;
    any = true;
  }
  return runs;
}

// How far the two halves of a run are apart in elevation, on average over the runs: a wrong seam makes runs
// of halves of two rows.
float bend(const PolarPoints& polar, const RowRuns& runs) {
  constexpr std::size_t kSamples = 9;
  float sum = 0;
  for (std::size_t run = 0; run < runs.runs(); ++run) {
    const std::size_t first = runs.first[run];
    const std::size_t length = runs.end(run, polar.size()) - first;
    float medians[2] = {};
    for (std::size_t half = 0; half < 2; ++half) {
      std::array<float, kSamples> elevations{};
      std::size_t count = 0;
      for (std::size_t k = 0; k < kSamples; ++k) {
        const std::size_t i = first + (half * kSamples + k) * length / (2 * kSamples);
        if (polar.has_ray(i)) elevations[count++] = polar.z_m[i] / polar.rho_m[i];
      }
      if (count == 0) continue;
      const auto middle = elevations.begin() + static_cast<std::ptrdiff_t>(count / 2);
      std::nth_element(elevations.begin(), middle, elevations.begin() + static_cast<std::ptrdiff_t>(count));
      medians[half] = *middle;
    }
    sum += std::fabs(medians[0] - medians[1]);
  }
  return sum / static_cast<float>(std::max<std::size_t>(1, runs.runs()));
}

}  // namespace

RowRuns split_into_runs(const PolarPoints& polar) {
  RowRuns front = split(polar, false);
  RowRuns back = split(polar, true);
  return bend(polar, back) < 0.7F * bend(polar, front) ? back : front;
}

}  // namespace pointreel
