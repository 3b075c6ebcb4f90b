#include "planes/angular_grid.h"

#include <cmath>
#include <string>

namespace pointreel {

Result<AngularGrid> AngularGrid::create(double azimuth_step_rad, double elevation_step_rad) {
  for (const double step : {azimuth_step_rad, elevation_step_rad}) {
    if (!(step >= kMinStep_rad && step <= kMaxStep_rad)) {
      return Error{ErrorCode::invalid_argument,
                   "azimuth and elevation steps must lie between " +
                       std::to_string(radians_to_degrees(kMinStep_rad)) + " and " +
                       std::to_string(radians_to_degrees(kMaxStep_rad)) + " deg, got " +
                       std::to_string(radians_to_degrees(step)) + " deg"};
    }
  }
  return AngularGrid(azimuth_step_rad, elevation_step_rad);
}

AngularGrid::AngularGrid(double azimuth_step_rad, double elevation_step_rad)
    : azimuth_step_rad_(azimuth_step_rad),
      elevation_step_rad_(elevation_step_rad),
      columns_per_rad_(static_cast<float>(1 / azimuth_step_rad)),
      rows_per_rad_(static_cast<float>(1 / elevation_step_rad)),
      // A step that divides the circle up to rounding must not get a sliver of a column more.
      rows_(static_cast<int>(std::ceil(kPi / elevation_step_rad - 1e-6))),
      columns_(static_cast<int>(std::ceil(kTurn / azimuth_step_rad - 1e-6))) {
  for (int column = 0; column < columns_; ++column) {
    const SinCos azimuth = sin_cos((column + 0.5) * azimuth_step_rad_);
    cos_azimuth_.push_back(static_cast<float>(azimuth.cos));
    sin_azimuth_.push_back(static_cast<float>(azimuth.sin));
  }
  for (int row = 0; row < rows_ + kSpareRows; ++row) {
    const SinCos elevation = sin_cos(kPi / 2 - (row + 0.5) * elevation_step_rad_);
    cos_elevation_.push_back(static_cast<float>(elevation.cos));
    sin_elevation_.push_back(static_cast<float>(elevation.sin));
  }
}

}  // namespace pointreel
