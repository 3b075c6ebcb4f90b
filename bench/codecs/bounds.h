// The largest errors that every codec with a bound is run at, and how settings spell lengths.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

namespace pointreel {

inline constexpr std::array kBounds_m = {0.01, 0.02, 0.05, 0.1, 0.2};

inline std::string in_centimetres(double length_m) {
  return fmt::format("{:g} cm", 100 * length_m);
}

}  // namespace pointreel
