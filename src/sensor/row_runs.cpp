#include "sensor/row_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace pointreel {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

// Which way the sensor turns: the sign of most small steps.
bool turns_down(const PolarPoints& polar) {
  constexpr float kSmall = 0.1F;
  std::uint32_t up = 0;
  std::uint32_t down = 0;
  for (std::size_t i = 1; i < polar.size(); ++i) {
    const float step = polar.azimuth_rad[i] - polar.azimuth_rad[i - 1];
    const bool small = polar.rho_m[i] > 0 && polar.rho_m[i - 1] > 0 && std::fabs(step) < kSmall;
    up += small && step > 0 ? 1 : 0;
    down += small && step < 0 ? 1 : 0;
  }
  return down > up;
}

struct BothSeams {
  RowRuns front, behind;  // a seam at azimuth 0, or behind the sensor
};

BothSeams split(const PolarPoints& polar) {
  BothSeams both;
  both.front.descending = both.behind.descending = turns_down(polar);
  const float direction = both.front.descending ? -1.0F : 1.0F;
  float before = 0;
  bool any = false;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const float here = polar.azimuth_rad[i];
    if (!any) {
      both.front.first.push_back(0);
      both.behind.first.push_back(0);
      any = true;
    } else {
      const float back = direction * (before - here);
      if (back > 1) both.behind.first.push_back(i);
      // From azimuth 0 on, points behind the sensor's left come a turn later.
      const float turns = (before < 0 ? kTurn : 0.0F) - (here < 0 ? kTurn : 0.0F);
      if (back + direction * turns > 1) both.front.first.push_back(i);
    }
    before = here;
  }
  return both;
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
  BothSeams both = split(polar);
  const bool behind = bend(polar, both.behind) < 0.7F * bend(polar, both.front);
  return std::move(behind ? both.behind : both.front);
}

}  // namespace pointreel
