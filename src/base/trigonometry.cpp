#include "base/trigonometry.h"

namespace pointreel {
namespace {

// Taylor series on [-pi/4, pi/4]; the first omitted terms are below 2e-17.
double sin_series(double x) {
  const double x2 = x * x;
  double sum = 1.0;
  for (int k = 17; k >= 3; k -= 2) sum = 1.0 - sum * x2 / (k * (k - 1));
  return x * sum;
}

double cos_series(double x) {
  const double x2 = x * x;
  double sum = 1.0;
  for (int k = 18; k >= 2; k -= 2) sum = 1.0 - sum * x2 / (k * (k - 1));
  return sum;
}

}  // namespace

SinCos sin_cos(double angle_rad) {
  const double quarters = angle_rad * (2.0 / kPi);
  const long quadrant = static_cast<long>(quarters + (quarters < 0 ? -0.5 : 0.5));
  // pi/2 in two parts: the first has few enough bits that its product with a small integer is exact.
  const double rest = (angle_rad - static_cast<double>(quadrant) * 1.5707963267341256) -
                      static_cast<double>(quadrant) * 6.077100506506192e-11;
  const double s = sin_series(rest);
  const double c = cos_series(rest);
  switch (quadrant & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace pointreel
