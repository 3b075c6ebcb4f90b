// Closed-form least-squares plane through the returns of range image cells.
//
// A plane is n with n.p = 1 for its points, which every plane that the sensor can see satisfies (it does not
// pass through the sensor). The paper's x + a y + b z = c cannot express the ground. Along a unit ray u the
// plane is met at range 1 / (n.u): 1/r is linear in n.
#pragma once

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

  // The same for points in the sensor's coordinates; `counts`: 1 or 0. Eigen arrays of one size.
  template <class Array>
  void add_points(const Array& x, const Array& y, const Array& z, const Array& counts) {
    const Array r2 = counts * (x * x + y * y + z * z);
    const Array wx = r2 * x, wy = r2 * y, wz = r2 * z;
    xx_ += (wx * x).sum(), xy_ += (wx * y).sum(), xz_ += (wx * z).sum();
    yy_ += (wy * y).sum(), yz_ += (wy * z).sum(), zz_ += (wz * z).sum();
    x_ += wx.sum(), y_ += wy.sum(), z_ += wz.sum();
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
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  double x_ = 0, y_ = 0, z_ = 0;
};

}  // namespace pointreel
