#include "codec/error_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace pointreel {
namespace {

constexpr double kCorrectionBits = 12;
// What a range costs less per octave of the step: all of it where noise is coded, about half at decimetres.
constexpr double kBitsPerOctave = 0.7;
// Ranges are float32: the decoded one is this much coarser than the step says.
constexpr double kFloatRounding = 1.5 / (1 << 24);

}  // namespace

RangeQuantiser choose_quantiser(const SensorModel& model, const GriddedSweep& sweep, double max_error_m) {
  // How far points are off their rays, by parts of the bound; the last one is for those beyond it.
  constexpr std::size_t kParts = 512;
  constexpr std::size_t kSampleEvery = 7;
  std::array<std::uint32_t, kParts + 1> points_in_part{};
  const auto parts_per_m = static_cast<float>(kParts / max_error_m);
  std::uint32_t points = 0;
  float farthest_m = 0;
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); i += kSampleEvery) {
    if (sweep.cell_of_point[i] < 0) continue;
    const float part = sweep.deviation_m[i] * parts_per_m;
    ++points_in_part[part < kParts ? static_cast<std::size_t>(part) : kParts];
    ++points;
    farthest_m = std::max(farthest_m, sweep.range_m[i]);
  }

  // For deviations up to d the range may be off by sqrt(E^2 - d^2); of the points beyond, those near the
  // border of their bin miss.
  double best_step_m = 0, best_bits = 0;
  std::uint32_t within = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    within += points_in_part[part];
    const double deviation_m = static_cast<double>(part + 1) / kParts * max_error_m;
    const double left_m = std::sqrt(max_error_m * max_error_m - deviation_m * deviation_m);
    const double step_m = 2 * (left_m - kFloatRounding * static_cast<double>(farthest_m));
    if (step_m < max_error_m / 8) break;
    const double beyond = static_cast<double>(points - within) / std::max(points, 1U);
    const double bits = -kBitsPerOctave * std::log2(step_m) + kCorrectionBits * 0.5 * beyond;
    if (best_step_m == 0 || bits < best_bits) {
      best_step_m = step_m;
      best_bits = bits;
    }
  }
  // Rays that miss nearly every point by more than the bound: all are corrected anyway.
  if (best_step_m == 0) best_step_m = max_error_m;

  RangeQuantiser quantiser;
  quantiser.step_m = static_cast<float>(best_step_m);
  // On the sensor's own lattice the range is nearly exact, at a coarser step than the bound would ask for.
  if (model.range_step_m > best_step_m && model.range_step_m <= 3 * max_error_m) {
    quantiser.step_m = static_cast<float>(model.range_step_m);
    quantiser.lattice_phase_m = lattice_phases_m(model);
  }
  return quantiser;
}

std::vector<float> lattice_phases_m(const SensorModel& model) {
  std::vector<float> phases_m;
  for (const double phase : model.range_phase) {
    phases_m.push_back(static_cast<float>(phase * model.range_step_m));
  }
  return phases_m;
}

}  // namespace pointreel
