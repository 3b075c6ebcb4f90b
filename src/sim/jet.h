// A function of time with its first two derivatives, so that velocity and acceleration follow exactly.
#pragma once

#include <cmath>

namespace pointreel::sim {

struct Jet {
  double value = 0;
  double rate = 0;          // d/dt
  double acceleration = 0;  // d2/dt2

  Jet() = default;
  Jet(double constant) : value(constant) {}
  Jet(double v, double r, double a) : value(v), rate(r), acceleration(a) {}
  static Jet time(double time_s) { return {time_s, 1, 0}; }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration};
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration};
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.rate * b.value + a.value * b.rate,
            a.acceleration * b.value + 2 * a.rate * b.rate + a.value * b.acceleration};
  }
};

// f(x) by the chain rule from f, f' and f'' at x.value.
inline Jet chain(const Jet& x, double f, double df, double ddf) {
  return {f, df * x.rate, ddf * x.rate * x.rate + df * x.acceleration};
}

inline Jet sin(const Jet& x) {
  const double s = std::sin(x.value);
  return chain(x, s, std::cos(x.value), -s);
}
inline Jet cos(const Jet& x) {
  const double c = std::cos(x.value);
  return chain(x, c, -std::sin(x.value), -c);
}
inline Jet atan(const Jet& x) {
  const double d = 1 / (1 + x.value * x.value);
  return chain(x, std::atan(x.value), d, -2 * x.value * d * d);
}

}  // namespace pointreel::sim
