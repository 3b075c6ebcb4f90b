// How far side offsets turn points: atan2(h, rho). For blocks of them it is the encoder's own; the decoder
// has row_walk.h, which shares the series, and ray_table.h.
#pragma once

#include <cmath>
#include <cstddef>

#include "base/trigonometry.h"

namespace pointreel {

// Of t = h / rho.
inline float arc_tangent_series(float t) {
  const float t2 = t * t;
  return t - t * t2 * (1.0F / 3 - t2 * (1.0F / 5));
}

inline void side_turns(const float* side_m, const float* rho_m, std::size_t count, float* turn_rad) {
  constexpr float kSmall = 0.05F;  // up to here the series is off by less than 1e-9
  int large = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float t = side_m[k] / rho_m[k];
    turn_rad[k] = arc_tangent_series(t);
    large |= !(std::fabs(t) < kSmall) ? 1 : 0;
  }
  if (large == 0) return;
  for (std::size_t k = 0; k < count; ++k) turn_rad[k] = fast_atan2(side_m[k], rho_m[k]);
}

}  // namespace pointreel
