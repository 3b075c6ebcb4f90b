#include "sensor/row_runs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "base/parallel.h"
#include "base/simd_loops.h"

namespace pointreel {
namespace {

constexpr float kTurnRad = 2 * std::numbers::pi_v<float>;

// Which way the sensor turns: the sign of most small steps.
bool turns_down(const PolarPoints& polar, int threads) {
  constexpr float kSmall = 0.1F;
  std::atomic<std::uint32_t> all_up = 0, all_down = 0;
  const float* azimuth_rad = polar.azimuth_rad.data();
  const float* rho_m = polar.rho_m.data();
  for_each_piece(polar.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    std::uint32_t up = 0;
    std::uint32_t down = 0;
    for (std::size_t i = std::max<std::size_t>(first, 1); i < last; ++i) {
      const float step = azimuth_rad[i] - azimuth_rad[i - 1];
      const int rays = (rho_m[i] > 0) & (rho_m[i - 1] > 0);
      up += static_cast<std::uint32_t>(rays & (step > 0) & (step < kSmall));
      down += static_cast<std::uint32_t>(rays & (step < 0) & (step > -kSmall));
    }
    all_up += up;
    all_down += down;
  });
  return all_down > all_up;
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

// Per piece of the points, how many there are up to the last one before it with a ray: 0 if none has one.
std::vector<std::size_t> ends_of_rays_before(const PolarPoints& polar) {
  std::vector<std::size_t> ends;
  std::size_t end = 0;
  for (std::size_t first = 0; first < polar.size(); first += kPiecePoints) {
    ends.push_back(end);
    for (std::size_t i = std::min(polar.size(), first + kPiecePoints); i > first; --i) {
      if (!polar.has_ray(i - 1)) continue;
      end = i;
      break;
    }
  }
  return ends;
}

// Runs that start at points from `first` to before `last`. `rays_before_end`: see above.
POINTREEL_SIMD_LOOPS void split(const PolarPoints& polar, float direction, std::size_t rays_before_end,
                                std::size_t first, std::size_t last, BothSeams& both) {
  const float* azimuth_rad = polar.azimuth_rad.data();
  const float* rho_m = polar.rho_m.data();
  bool any = rays_before_end > 0;
  float before = any ? azimuth_rad[rays_before_end - 1] : 0;
  const auto step_to = [&](std::size_t i) {
    if (!polar.has_ray(i)) return;
    const float here = azimuth_rad[i];
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
  for (std::size_t block = first; block < last; block += kBlock) {
    const std::size_t end = std::min(last, block + kBlock);
    int jumps = block == 0 || rho_m[block - 1] == 0 ? 1 : 0;
    for (std::size_t i = std::max<std::size_t>(block, 1); i < end; ++i) {
      const float one = jump_back(direction, azimuth_rad[i - 1], azimuth_rad[i]);
      const float other = jump_back(direction, from_front(azimuth_rad[i - 1]), from_front(azimuth_rad[i]));
      jumps |= (one > 1) | (other > 1) | (rho_m[i] == 0);
    }
    if (jumps == 0) {
      before = azimuth_rad[end - 1];
      continue;
    }
    for (std::size_t i = block; i < end; ++i) step_to(i);
  }
}

BothSeams split(const PolarPoints& polar, int threads) {
  BothSeams both;
  both.front.descending = both.behind.descending = turns_down(polar, threads);
  std::vector<BothSeams> pieces((polar.size() + kPiecePoints - 1) / kPiecePoints);
  const auto ends_before = ends_of_rays_before(polar);
  for_each_piece(polar.size(), threads, [&](std::size_t piece, std::size_t first, std::size_t last) {
    split(polar, both.front.descending ? -1.0F : 1.0F, ends_before[piece], first, last, pieces[piece]);
  });
  for (const BothSeams& piece : pieces) {
    both.front.first.insert(both.front.first.end(), piece.front.first.begin(), piece.front.first.end());
    both.behind.first.insert(both.behind.first.end(), piece.behind.first.begin(), piece.behind.first.end());
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
      float* const middle = elevations.data() + count / 2;
      std::nth_element(elevations.data(), middle, elevations.data() + count);
      medians[half] = *middle;
    }
    sum += std::fabs(medians[0] - medians[1]);
  }
  return sum / static_cast<float>(std::max<std::size_t>(1, runs.runs()));
}

}  // namespace

RowRuns split_into_runs(const PolarPoints& polar, int threads) {
  BothSeams both = split(polar, threads);
  const bool behind = bend(polar, both.behind) < 0.7F * bend(polar, both.front);
  return std::move(behind ? both.behind : both.front);
}

}  // namespace pointreel
