// Sine, cosine and arctangent from + - * / only, so that every processor computes the same bits.
// (libm's results differ in the last digit between C libraries; a stream must not depend on them.)
#pragma once

#include <cmath>
#include <numbers>

namespace pointreel {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTurn = 2 * kPi;

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

// Chebyshev fit of atan(t)/t in t^2 over [0, 1], degree 9.
inline constexpr float kArcTangentCoefficients[] = {
    0.9999999971605452F,   -0.33333276291981084F, 0.19998075281120445F, -0.14260016082617188F,
    0.10932341500583656F,  -0.08349724966914496F, 0.05708955591530535F, -0.030351864777082425F,
    0.010487649252677426F, -0.001701170063940315F};

// atan2(y, x) in (-pi, pi], absolute error below 4e-7 rad (40 um at 100 m); atan2(0, 0) is 0. Float and free
// of branches, so that loops over points become SIMD code.
inline float fast_atan2(float y, float x) {
  constexpr float kSmallest = 1e-37F;  // keeps 0/0 away
  constexpr auto kHalfTurn = static_cast<float>(kPi);
  const float ax = std::fabs(x);
  const float ay = std::fabs(y);
  const float larger = ax > ay ? ax : ay;
  const float smaller = ax > ay ? ay : ax;
  const float t = smaller / (larger > kSmallest ? larger : kSmallest);
  const float t2 = t * t;
  float ratio = kArcTangentCoefficients[9];
  for (int i = 8; i >= 0; --i) ratio = ratio * t2 + kArcTangentCoefficients[i];
  float angle = ratio * t;
  angle = ay > ax ? kHalfTurn / 2 - angle : angle;
  angle = x < 0 ? kHalfTurn - angle : angle;
  return y < 0 ? -angle : angle;
}

}  // namespace pointreel
