// Moving cars: one ahead and one behind in our lane, a stream in the other.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/road.h"
#include "sim/scene_object.h"
#include "sim/vehicle_motion.h"

namespace pointreel::sim {

class Traffic {
 public:
  Traffic(const Road& road, const VehicleMotion& motion, double speed_mps, std::uint64_t seed)
      : road_(road), motion_(motion), oncoming_speed_mps_(speed_mps), seed_(seed) {}

  // Appends the cars with world x within reach_m of ours, moving from their places at begin_s to those at
  // end_s.
  void append_cars(double begin_s, double end_s, double reach_m, std::vector<SceneObject>& objects) const;

 private:
  void append_car_between(double begin_x_m, double end_x_m, double duration_s, double lane_m,
                          std::uint64_t salt, std::vector<SceneObject>& objects) const;

  const Road& road_;
  const VehicleMotion& motion_;
  double oncoming_speed_mps_;
  std::uint64_t seed_;
};

}  // namespace pointreel::sim
