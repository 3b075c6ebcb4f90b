// The motion that a compensated sweep was freed of, before anything is known of the sensor.
#pragma once

#include <cstdint>
#include <optional>

#include "pointreel/point_cloud.h"
#include "sensor/sweep_grid.h"
#include "sensor/tick_lattice.h"

namespace pointreel {

struct BlindTwist {
  Twist twist;
  std::uint32_t ticks_per_turn = 0;
  double scatter_m = 0;  // median distance of the points from their rows' lines once the motion is put back
};

// From the points of each row alone. The yaw is known up to a multiple of one tick per turn,
// which the number of ticks takes up: of the numbers possible the roundest is chosen. None: no ticks appear.
std::optional<BlindTwist> find_twist_blind(const PointCloud& cloud, const RowPoints& rows);

}  // namespace pointreel
