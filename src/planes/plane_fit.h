// Closed-form least-squares plane through the returns of range image cells.
//
// A plane is n with n.p = 1 for its points, which every plane that the sensor can see satisfies (it does not
// pass through the sensor). The paper's x + a y + b z = c cannot express the ground. Along a unit ray u the
// plane is met at range 1 / (n.u): 1/r is linear in n.
#pragma once

#include <array>
#include <cstddef>

namespace pointreel {

struct Plane {
  double x = 0, y = 0, z = 0;  // n, 1/m; the unit normal is n/|n|, the distance from the sensor 1/|n|
};

// Sums for minimising sum w (n.u - 1/r)^2 with w = r^4, which makes the sum that of squared range errors to
// first order (dr = r^2 d(1/r)). Sums of tiles add up, so growing a run costs one addition.
class PlaneMoments {
 public:
  void add(double ux, double uy, double uz, double range_m) {
    const double r2 = range_m * range_m;
    const double w = r2 * r2;
    const double wx = w * ux, wy = w * uy, wz = w * uz;
    xx_ += wx * ux, xy_ += wx * uy, xz_ += wx * uz, yy_ += wy * uy, yz_ += wy * uz, zz_ += wz * uz;
    const double b = r2 * range_m;  // w / r
    x_ += b * ux, y_ += b * uy, z_ += b * uz;
  }

  PlaneMoments& operator+=(const PlaneMoments& other) {
    xx_ += other.xx_, xy_ += other.xy_, xz_ += other.xz_, yy_ += other.yy_, yz_ += other.yz_,
        zz_ += other.zz_;
    x_ += other.x_, y_ += other.y_, z_ += other.z_;
    return *this;
  }

  // Always solvable for at least one point: a ridge of 1e-10 of the trace decides what the points leave open
  // (one row of cells, one point) and moves the fit of a well-spread tile by less than a micrometre.
  Plane fit() const;

 private:
  template <std::size_t kLanes>
  friend class PlaneMomentLanes;

  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  double x_ = 0, y_ = 0, z_ = 0;
};

// The same for points in the sensor's coordinates, summed in lanes: loops over them become SIMD code.
template <std::size_t kLanes>
class PlaneMomentLanes {
 public:
  // `counts`: 1 or 0.
  void add(std::size_t lane, double x_m, double y_m, double z_m, double counts) {
    const double r2 = counts * (x_m * x_m + y_m * y_m + z_m * z_m);
    const double wx = r2 * x_m, wy = r2 * y_m, wz = r2 * z_m;
    xx_[lane] += wx * x_m, xy_[lane] += wx * y_m, xz_[lane] += wx * z_m;
    yy_[lane] += wy * y_m, yz_[lane] += wy * z_m, zz_[lane] += wz * z_m;
    x_[lane] += wx, y_[lane] += wy, z_[lane] += wz;
  }
  PlaneMoments total() const {
    PlaneMoments sums;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sums.xx_ += xx_[lane], sums.xy_ += xy_[lane], sums.xz_ += xz_[lane];
      sums.yy_ += yy_[lane], sums.yz_ += yz_[lane], sums.zz_ += zz_[lane];
      sums.x_ += x_[lane], sums.y_ += y_[lane], sums.z_ += z_[lane];
    }
    return sums;
  }

 private:
  using Lanes = std::array<double, kLanes>;
  Lanes xx_{}, xy_{}, xz_{}, yy_{}, yz_{}, zz_{};
  Lanes x_{}, y_{}, z_{};
};

}  // namespace pointreel
