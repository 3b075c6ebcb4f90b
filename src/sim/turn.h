// A full turn.
#pragma once

#include <numbers>

namespace pointreel::sim {

inline constexpr double two_pi = 2 * std::numbers::pi;  // rad

}  // namespace pointreel::sim
