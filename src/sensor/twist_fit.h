// The motion that a compensated sweep was freed of, found from the rows and ticks that it hides.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"
#include "sensor/tick_lattice.h"

namespace pointreel {

struct BlindTwist {
  Twist twist;
  std::uint32_t ticks_per_turn = 0;
  double scatter_m = 0;  // median distance of the points from their rows' lines once the motion is put back
};

// Without a model, from the points of each row alone. The yaw is known up to a multiple of one tick per turn,
// which the number of ticks takes up: of the numbers possible the roundest is chosen. None: no ticks appear.
std::optional<BlindTwist> find_twist_blind(const PointCloud& cloud, const RowPoints& rows);

// With a model: rows[i] is the row of point i, negative for none. Found to about 0.1 mm and 1e-5 rad.
Twist find_twist(const SensorModel& model, const PointCloud& cloud, const std::vector<std::int16_t>& rows);

}  // namespace pointreel
