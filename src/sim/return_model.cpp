#include "sim/return_model.h"

#include <algorithm>
#include <cmath>

namespace pointreel::sim {
namespace {

constexpr double range_step_m = 0.002;
constexpr double intensity_step = 0.01;
// Reflectivity * cos(incidence) / range^2 of which half the shots are heard: asphalt at about 85 m.
constexpr double half_heard_signal = 8e-7;

}  // namespace

std::optional<Return> receive(const Hit& hit, const SimulatorOptions& options, Random& random) {
  const MaterialProperties& material = properties(hit.material);
  const double signal = material.reflectivity * hit.cos_incidence / (hit.range_m * hit.range_m);
  const double ratio = half_heard_signal / signal;
  const double heard = (1 - options.drop_out) * (1 - material.drop_out) / (1 + ratio * ratio);
  if (!random.chance(heard)) return std::nullopt;

  const double noise_m =
      std::sqrt(options.range_noise_m * options.range_noise_m + material.roughness_m * material.roughness_m);
  const double range_m = hit.range_m + noise_m * random.normal();
  const double intensity = material.reflectivity * (0.4 + 0.6 * hit.cos_incidence) + 0.03 * random.normal();
  return Return{std::round(range_m / range_step_m) * range_step_m,
                intensity_step * std::clamp(std::floor(intensity / intensity_step), 0.0, 99.0)};
}

}  // namespace pointreel::sim
