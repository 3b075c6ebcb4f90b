#include <algorithm>
#include <cmath>
#include <string>

#include "base/trigonometry.h"
#include "codec/wire.h"
#include "planes/angular_grid.h"

namespace pointreel {

bool StreamHeader::on_sensor_grid() const {
  return method == Method::mixture || planes.grid == PlaneGrid::sensor;
}

double StreamHeader::bound_m() const {
  if (on_sensor_grid()) return max_error_m;
  return planes.residual_mode == ResidualMode::raw_float
             ? planes.threshold_m
             : std::max(planes.threshold_m, planes.residual_step_m / 2);
}

Result<void> validate(const StreamHeader& header) {
  const auto out_of_range = [](const char* option, double value, const char* range) {
    return Error{ErrorCode::invalid_argument,
                 std::string(option) + " must lie in " + range + ", got " + std::to_string(value)};
  };
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  const PlanesOptions& planes = header.planes;
  if (header.method != Method::planes && header.method != Method::mixture) {
    return Error{ErrorCode::unsupported,
                 "method " + std::to_string(static_cast<int>(header.method)) + " is not known"};
  }
  if (header.on_sensor_grid()) {
    if (!within(header.max_error_m, 0.0005, 1)) {
      return out_of_range("max-error", header.max_error_m, "0.0005 to 1 m");
    }
    if (!within(header.group, 1, 255)) return out_of_range("group", header.group, "1 to 255 sweeps");
    if (header.effort > Effort::max) {
      return Error{ErrorCode::invalid_argument,
                   "effort " + std::to_string(static_cast<int>(header.effort)) + " is not known"};
    }
    return {};
  }
  if (planes.grid != PlaneGrid::uniform) {
    return Error{ErrorCode::unsupported,
                 "grid " + std::to_string(static_cast<int>(planes.grid)) + " is not known"};
  }
  if (!within(planes.threshold_m, 0.001, 10))
    return out_of_range("threshold", planes.threshold_m, "0.001 to 10 m");
  if (!within(planes.tile_size, 2, 16)) return out_of_range("tile", planes.tile_size, "2 to 16 cells");
  if (!within(planes.group, 1, 255)) return out_of_range("group", planes.group, "1 to 255 sweeps");
  if (planes.residual_mode == ResidualMode::stepped) {
    if (!within(planes.residual_step_m, 0.001, 20)) {
      return out_of_range("residual-step", planes.residual_step_m, "0.001 to 20 m");
    }
  } else if (planes.residual_mode != ResidualMode::raw_float || planes.residual_step_m != 0) {
    return Error{ErrorCode::invalid_argument, "residual-step: unknown mode or a step with raw ranges"};
  }
  const auto grid = AngularGrid::create(planes.azimuth_step_rad, planes.elevation_step_rad);
  if (!grid) return grid.error();
  return {};
}

}  // namespace pointreel
