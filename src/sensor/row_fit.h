// Slope and offset of one row from its points, whatever else is among them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sensor/polar_points.h"

namespace pointreel {

struct RowFit {
  bool usable = false;
  double slope = 0;
  double offset_m = 0;
  double scatter_m = 0;  // median distance of the points from the line
};

RowFit fit_row(const PolarPoints& polar, std::span<const std::uint32_t> points);

}  // namespace pointreel
