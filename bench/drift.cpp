#include "drift.h"

#include <algorithm>
#include <numbers>

#include "common/quality.h"

namespace pointreel {

Drift drift_of(const MotionTrack& track, std::span<const Pose> T_world_sensor) {
  std::vector<Pose> T_first_sweep = {Pose::Identity()};
  std::vector<double> travelled_m = {0};
  for (std::size_t i = 1; i < T_world_sensor.size(); ++i) {
    T_first_sweep.push_back(T_first_sweep.back() * track.T_previous_sweep[i - 1]);
    travelled_m.push_back(travelled_m.back() +
                          (T_world_sensor[i].translation() - T_world_sensor[i - 1].translation()).norm());
  }
  Drift drift;
  drift.path_m = travelled_m.back();
  drift.median_cpu_ms = quantile(track.cpu_ms, 0.5);
  drift.failures = track.failures;
  std::vector<double> step_errors_m;
  int pairs = 0;
  for (std::size_t i = 0; i < T_world_sensor.size(); ++i) {
    for (std::size_t j = i + 1; j < T_world_sensor.size(); ++j) {
      const Pose truth = T_world_sensor[i].inverse() * T_world_sensor[j];
      const Pose error = truth.inverse() * (T_first_sweep[i].inverse() * T_first_sweep[j]);
      if (j == i + 1) step_errors_m.push_back(error.translation().norm());
      const double between_m = travelled_m[j] - travelled_m[i];
      if (2 * (j - i) < T_world_sensor.size() - 1 || between_m <= 0) continue;
      ++pairs;
      drift.translation_percent += 100 * error.translation().norm() / between_m;
      drift.rotation_deg_per_100m +=
          100 * Eigen::AngleAxisd(error.linear()).angle() * 180 / std::numbers::pi / between_m;
    }
  }
  drift.translation_percent /= std::max(1, pairs);
  drift.rotation_deg_per_100m /= std::max(1, pairs);
  drift.median_step_error_m = quantile(step_errors_m, 0.5);
  drift.largest_step_error_m = quantile(step_errors_m, 1);
  return drift;
}

}  // namespace pointreel
