// One step of the fit of a compensated sweep's motion.
#pragma once

#include <cstdint>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/polar_points.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Points of a compensated sweep, sorted by row.
struct TwistSamples {
  PointCloud cloud;
  std::vector<std::uint32_t> row;
  std::size_t size() const { return row.size(); }
  void add(const Point3f& p, std::uint32_t its_row) {
    cloud.positions.push_back(p);
    row.push_back(its_row);
  }
};

struct TwistStep {
  double scatter_m = 0;  // median distance from the rows' lines before the step
  double change = 0;     // largest of any component
};

// What the fit compares the samples with.
struct TwistTarget {
  std::uint32_t ticks_per_turn = 0;  // 0: heights only, which do not tell the yaw
  bool rows_free = false;            // the rows' lines are estimated along with the twist, and forgotten
};

// A round of Gauss-Newton.
TwistStep improve(const TwistSamples& samples, const std::vector<RowModel>& rows, const TwistTarget& target,
                  Twist& twist);

// The nearest twist that the stream can carry.
Twist rounded(Twist twist);

}  // namespace pointreel
