// The ground: a crowned road between curbs, sidewalks and yards beyond; flat where a street crosses.
#pragma once

#include <optional>
#include <vector>

#include "sim/ray_cast.h"
#include "sim/road.h"

namespace pointreel::sim {

// A stretch of the road where a side street crosses, in world x.
struct Crossing {
  double begin_x_m, end_x_m;
};

class Ground {
 public:
  // Valid for world x in [begin_x_m, end_x_m]; beyond, it goes on as at the end.
  Ground(const Road& road, const std::vector<Crossing>& crossings, double begin_x_m, double end_x_m);

  double height_m(double x_m, double y_m) const;
  std::optional<Hit> cast(const Ray& ray_world, double max_range_m) const;

 private:
  struct Station {
    double y_m, cos_heading, curb_height_m;
  };
  struct Place {
    double lateral_m, curb_height_m;
  };
  Place locate(double x_m, double y_m) const;
  Material material_at(double x_m, const Place& place) const;

  double begin_x_m_;
  std::vector<Station> stations_;  // equally spaced in x
};

}  // namespace pointreel::sim
