#include "sensor/sensor_model.h"

#include <cmath>

#include "base/trigonometry.h"

namespace pointreel {
namespace {

double to_step(double value, double step) {
  return std::nearbyint(value / step) * step;
}

}  // namespace

RowModel rounded(const RowModel& row) {
  double turns = to_step(row.azimuth_rad / kTurn, kAzimuthStepTurns);
  turns -= std::ceil(turns - 0.5);
  return {to_step(row.slope, kSlopeStep), to_step(row.offset_m, kOffsetStepM), turns * kTurn,
          to_step(row.side_offset_m, kOffsetStepM)};
}

}  // namespace pointreel
