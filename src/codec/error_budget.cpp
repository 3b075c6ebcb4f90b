#include "codec/error_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pointreel {
namespace {

constexpr double kCorrectionBits = 12;
// What a range costs less per octave of the step: all of it where noise is coded, about half at decimetres.
constexpr double kBitsPerOctave = 0.7;
// Ranges are float32: the decoded one is this much coarser than the step says.
constexpr double kFloatRounding = 1.5 / (1 << 24);

// Of values that are left so that all before it are no greater: asked for descending shares, each takes less
// work than the one before.
float quantile(std::vector<float>& values, double share, std::size_t& end) {
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  const auto at = [&](std::size_t k) { return values.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(0), at(place), at(end));
  end = place + 1;
  return values[place];
}

}  // namespace

RangeQuantiser choose_quantiser(const SensorModel& model, const GriddedSweep& sweep, double max_error_m) {
  std::vector<float> deviations_m;
  double farthest_m = 0;
  constexpr std::size_t kSampleEvery = 7;
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); i += kSampleEvery) {
    if (sweep.cell_of_point[i] < 0) continue;
    deviations_m.push_back(sweep.deviation_m[i]);
    farthest_m = std::max(farthest_m, static_cast<double>(sweep.range_m[i]));
  }
  double best_step_m = 0, best_bits = 0;
  std::size_t end = deviations_m.size();

  // For deviations up to d the range may be off by sqrt(E^2 - d^2); of the points beyond, those near the
  // border of their bin miss.
  for (const double share : {1.0, 0.999, 0.99, 0.97, 0.9, 0.75, 0.5, 0.25, 0.0}) {
    const double deviation_m = deviations_m.empty() ? 0 : quantile(deviations_m, share, end);
    const double left_m = std::sqrt(std::max(0.0, max_error_m * max_error_m - deviation_m * deviation_m));
    const double step_m = 2 * (left_m - kFloatRounding * farthest_m);
    if (step_m < max_error_m / 8) continue;
    const double bits = -kBitsPerOctave * std::log2(step_m) + kCorrectionBits * 0.5 * (1 - share);
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
