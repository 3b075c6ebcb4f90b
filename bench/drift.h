// How far the poses of a method are from the true ones, and what they took.
#pragma once

#include <span>
#include <vector>

#include "pointreel/motion.h"

namespace pointreel {

// What a method says of each sweep but the first.
struct MotionTrack {
  std::vector<Pose> T_previous_sweep;
  std::vector<double> cpu_ms;
  int failures = 0;
};

struct Drift {
  double path_m = 0;
  // Means over all pairs of sweeps at least half the drive apart, over the path between them: one pose of
  // GPS is uncertain by centimetres.
  double translation_percent = 0;
  double rotation_deg_per_100m = 0;
  double median_step_error_m = 0;  // from one sweep to the next
  double largest_step_error_m = 0;
  double median_cpu_ms = 0;
  int failures = 0;
};

// Truth has one pose more than the track.
Drift drift_of(const MotionTrack& track, std::span<const Pose> T_world_sensor);

}  // namespace pointreel
