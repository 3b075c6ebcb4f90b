#include "sensor/row_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace pointreel {
namespace {

constexpr float kTurnRad = 2 * std::numbers::pi_v<float>;

// Which way the sensor turns: the sign of most small steps.
bool turns_down(const PolarPoints& polar) {
  constexpr float kSmall = 0.1F;
  std::uint32_t up = 0;
  std::uint32_t down = 0;
  const float* azimuth_rad = polar.azimuth_rad.data();
  const float* rho_m = polar.rho_m.data();
  for (std::size_t i = 1; i < polar.size(); ++i) {
    const float step = azimuth_rad[i] - azimuth_rad[i - 1];
    const int rays = (rho_m[i] > 0) & (rho_m[i - 1] > 0);
    up += static_cast<std::uint32_t>(rays & (step > 0) & (step < kSmall));
    down += static_cast<std::uint32_t>(rays & (step < 0) & (step > -kSmall));
  }
  return down > up;
}

// From azimuth 0 on, points behind the sensor's left come a turn later.
float from_front(float azimuth_rad) {
  return azimuth_rad + (azimuth_rad < 0 ? kTurnRad : 0.0F);
}
float jump_back(float direction, float before_rad, float here_rad) {
  return direction * (before_rad - here_rad);
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
  const auto step_to = [&](std::size_t i) {
    if (!polar.has_ray(i)) return;
    const float here = polar.azimuth_rad[i];
    if (!any) {
      both.front.first.push_back(0);
      both.behind.first.push_back(0);
      any = true;
    } else {
      if (jump_back(direction, before, here) > 1) both.behind.first.push_back(i);
      if (jump_back(direction, from_front(before), from_front(here)) > 1) both.front.first.push_back(i);
    }
    before = here;
  };
  // Most blocks have no jump.
  constexpr std::size_t kBlock = 64;
  for (std::size_t first = 0; first < polar.size(); first += kBlock) {
    const std::size_t last = std::min(polar.size(), first + kBlock);
    const float* azimuth_rad = polar.azimuth_rad.data();
    const float* rho_m = polar.rho_m.data();
    int jumps = first == 0 || rho_m[first - 1] == 0 ? 1 : 0;
    for (std::size_t i = std::max<std::size_t>(first, 1); i < last; ++i) {
      const float one = jump_back(direction, azimuth_rad[i - 1], azimuth_rad[i]);
      const float other = jump_back(direction, from_front(azimuth_rad[i - 1]), from_front(azimuth_rad[i]));
      jumps |= (one > 1) | (other > 1) | (rho_m[i] == 0);
    }
    if (jumps == 0) {
      before = azimuth_rad[last - 1];
      continue;
    }
    for (std::size_t i = first; i < last; ++i) step_to(i);
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
