// The project's own sine, cosine and arctangent against libm's, whose errors are below 1e-15.
#include "base/trigonometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pointreel {
namespace {

constexpr double kSinCosError = 1e-15;
constexpr double kArctangentError_rad = 4e-7;

double sin_cos_error(double angle_rad) {
  const SinCos own = sin_cos(angle_rad);
  return std::max(std::fabs(own.sin - std::sin(angle_rad)), std::fabs(own.cos - std::cos(angle_rad)));
}

// libm has -pi where y is a negative zero and x is negative; 0.0 added makes it positive.
double arctangent_error_rad(double y, double x) {
  const auto float_y = static_cast<float>(y), float_x = static_cast<float>(x);
  return std::fabs(fast_atan2(float_y, float_x) - std::atan2(float_y + 0.0, static_cast<double>(float_x)));
}

TEST(SinCos, IsExactToFifteenDigitsOverTwoTurnsEitherWay) {
  constexpr int kSteps = 400'000;
  double worst = 0;
  for (int i = -kSteps; i <= kSteps; ++i) worst = std::max(worst, sin_cos_error(4 * kPi * i / kSteps));
  EXPECT_LT(worst, kSinCosError);
}

TEST(SinCos, HoldsOnBothSidesOfEveryQuadrantBorder) {
  for (int eighth = -16; eighth <= 16; ++eighth) {
    const double border = eighth * (kPi / 4);
    for (const double offset : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
      EXPECT_LT(sin_cos_error(border + offset), kSinCosError) << eighth << " + " << offset;
      EXPECT_LT(sin_cos_error(border - offset), kSinCosError) << eighth << " - " << offset;
    }
  }
}

TEST(SinCos, OfZeroIsExact) {
  EXPECT_EQ(sin_cos(0).sin, 0);
  EXPECT_EQ(sin_cos(0).cos, 1);
}

TEST(FastAtan2, IsWithinItsErrorAllAround) {
  constexpr int kSteps = 200'000;
  double worst = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double angle = kPi * i / kSteps;
    for (const double range : {1e-3, 1.0, 1e5}) {
      worst = std::max(worst, arctangent_error_rad(range * std::sin(angle), range * std::cos(angle)));
    }
  }
  EXPECT_LT(worst, kArctangentError_rad);
}

TEST(FastAtan2, HoldsAtAxesAndDiagonals) {
  const std::vector<double> small = {0, std::numeric_limits<float>::denorm_min(), 1e-30, 1e-12, 1e-3};
  for (const double major : {1.0, -1.0}) {
    for (const double minor : small) {
      for (const double sign : {1.0, -1.0}) {
        EXPECT_LT(arctangent_error_rad(sign * minor, major), kArctangentError_rad) << minor;
        EXPECT_LT(arctangent_error_rad(major, sign * minor), kArctangentError_rad) << minor;
        EXPECT_LT(arctangent_error_rad(major * (1 + minor), sign), kArctangentError_rad) << minor;
        EXPECT_LT(arctangent_error_rad(sign, major * (1 - minor)), kArctangentError_rad) << minor;
      }
    }
  }
}

TEST(FastAtan2, OfTheOriginIsZeroAndOfTheNegativeAxisPi) {
  EXPECT_EQ(fast_atan2(0, 0), 0);
  EXPECT_EQ(fast_atan2(-0.0F, 0.0F), 0);
  EXPECT_EQ(fast_atan2(0, -1), static_cast<float>(kPi));
  EXPECT_EQ(fast_atan2(-0.0F, -1),
            static_cast<float>(kPi));  // the interval is (-pi, pi], whatever the sign of the zero
}

}  // namespace
}  // namespace pointreel
