// Lengths and angles as users type them.
#pragma once

#include <string>
#include <string_view>

#include "pointreel/result.h"

namespace pointreel {

// "0.02", "2cm", "20mm", "0.02m" -> metres.
Result<double> parse_length_m(std::string_view text);
// "0.18deg", "0.18" (degrees), "0.003rad" -> radians.
Result<double> parse_angle_rad(std::string_view text);

double degrees(double radians);

// "1.2 MB"; decimal units.
std::string format_bytes(double bytes);

}  // namespace pointreel
