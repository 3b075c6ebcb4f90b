// The motion that a compensated sweep was freed of, found from the rows and ticks that it hides.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// rows[i] is the row of point i, negative for none. Found to about 0.1 mm and 1e-5 rad. `start`: a twist that
// may be near, say the previous sweep's.
Twist find_twist(const SensorModel& model, const PointCloud& cloud, const std::vector<std::int16_t>& rows,
                 const std::optional<Twist>& start = {});

}  // namespace pointreel
