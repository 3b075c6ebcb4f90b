// Sine, cosine and arctangent from + - * / only, so that every processor computes the same bits.
// (libm's results differ in the last digit between C libraries; a stream must not depend on them.)
#pragma once

#include <cmath>
#include <numbers>

namespace pointreel {

inline constexpr double kPi = std::numbers::pi;

constexpr double degrees_to_radians(double degrees) {
  return degrees * (kPi / 180.0);
}
constexpr double radians_to_degrees(double radians) {
  return radians * (180.0 / kPi);
}

struct SinCos {
  double sin = 0;
  double cos = 1;
};

// Absolute error below 1e-15 for |angle_rad| <= 4 pi.
SinCos sin_cos(double angle_rad);

// atan2(y, x) in (-pi, pi], absolute error below 2e-9 rad (0.2 um at 100 m). atan2(0, 0) is 0.
inline double fast_atan2(double y, double x) {
  // Chebyshev fit of atan(t)/t in t^2 over [0, 1], degree 9.
  constexpr double kCoefficients[] = {0.9999999971605452,   -0.33333276291981084,  0.19998075281120445,
                                      -0.14260016082617188, 0.10932341500583656,   -0.08349724966914496,
                                      0.05708955591530535,  -0.030351864777082425, 0.010487649252677426,
                                      -0.001701170063940315};
  const double ax = std::fabs(x);
  const double ay = std::fabs(y);
  const double larger = ax > ay ? ax : ay;
  const double smaller = ax > ay ? ay : ax;
  const double t = larger > 0 ? smaller / larger : 0.0;
  const double t2 = t * t;
  double ratio = kCoefficients[9];
  for (int i = 8; i >= 0; --i) ratio = ratio * t2 + kCoefficients[i];
  double angle = ratio * t;
  angle = ay > ax ? kPi / 2 - angle : angle;
  angle = x < 0 ? kPi - angle : angle;
  return y < 0 ? -angle : angle;
}

}  // namespace pointreel
