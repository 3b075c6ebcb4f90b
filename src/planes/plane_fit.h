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
  friend class PlaneMomentLanes;

  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  double x_ = 0, y_ = 0, z_ = 0;
};

// The same for points in the sensor's coordinates, summed in eight lanes: loops over them become SIMD code.
class PlaneMomentLanes {
 public:
  static constexpr std::size_t kLanes = 8;
  enum class First : bool { no, yes };

  // Each lane starts with a first point. `counts`: 1 or 0.
  template <First kFirst>
  void add(std::size_t lane, double x_m, double y_m, double z_m, double counts) {
    const double r2 = counts * (x_m * x_m + y_m * y_m + z_m * z_m);
    const double wx = r2 * x_m, wy = r2 * y_m, wz = r2 * z_m;
    const double terms[kSums] = {wx * x_m, wx * y_m, wx * z_m, wy * y_m, wy * z_m, wz * z_m, wx, wy, wz};
    for (std::size_t i = 0; i < kSums; ++i)
      sums_[i][lane] = kFirst == First::yes ? terms[i] : sums_[i][lane] + terms[i];
  }
  PlaneMoments total() const {
    PlaneMoments moments;
    double* const to[kSums] = {&moments.xx_, &moments.xy_, &moments.xz_, &moments.yy_, &moments.yz_,
                               &moments.zz_, &moments.x_,  &moments.y_,  &moments.z_};
    for (std::size_t i = 0; i < kSums; ++i) {
      const auto& lanes = sums_[i];
      *to[i] =
          ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
    }
    return moments;
  }

 private:
  static constexpr std::size_t kSums = 9;
  std::array<std::array<double, kLanes>, kSums> sums_;
};

}  // namespace pointreel
