// All that the sensor can see during one sweep, and where a beam ends in it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/ground.h"
#include "sim/ray_cast.h"
#include "sim/sector_index.h"
#include "sim/street.h"
#include "sim/traffic.h"
#include "sim/vehicle_motion.h"

namespace pointreel::sim {

class Scene {
 public:
  Scene(const Road& road, const VehicleMotion& motion, double traffic_speed_mps, double max_range_m,
        std::uint64_t seed);

  // Makes ready for a sweep. Sweeps must follow one another in time.
  void prepare(double begin_s, double end_s);

  // age_s: time since the sweep's start.
  std::optional<Hit> cast(const Ray& ray_world, double azimuth_world_rad, double age_s) const;

 private:
  const Road& road_;
  const VehicleMotion& motion_;
  double max_range_m_;
  Street street_;
  Traffic traffic_;
  std::vector<SceneObject> objects_;
  SectorIndex index_;
  std::optional<Ground> ground_;
};

}  // namespace pointreel::sim
