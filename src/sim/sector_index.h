// Which objects a beam can meet: candidates by azimuth sector around the sensor, nearest first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/motion.h"
#include "sim/scene_object.h"

namespace pointreel::sim {

class SectorIndex {
 public:
  struct Candidate {
    float min_distance_m;  // horizontal, over the whole sweep
    float min_slope;       // dz over horizontal distance of beams that can meet it
    float max_slope;
    std::uint32_t object;  // position in `objects`
  };

  // For a sweep during which the sensor moves straight from one pose to the other.
  void build(std::span<const SceneObject> objects, const Pose& T_world_begin, const Pose& T_world_end,
             double duration_s, double max_range_m);

  std::span<const Candidate> candidates(double azimuth_world_rad) const;

 private:
  static constexpr int sector_count = 720;
  std::vector<std::vector<Candidate>> sectors_{sector_count};
};

}  // namespace pointreel::sim
