#include "planes/plane_fit.h"

namespace pointreel {

Plane PlaneMoments::fit() const {
  const double ridge = 1e-10 * (xx_ + yy_ + zz_);
  const double xx = xx_ + ridge, yy = yy_ + ridge, zz = zz_ + ridge;
  // Cramer's rule on the symmetric 3x3 system.
  const double c_xx = yy * zz - yz_ * yz_, c_xy = xz_ * yz_ - xy_ * zz, c_xz = xy_ * yz_ - xz_ * yy;
  const double c_yy = xx * zz - xz_ * xz_, c_yz = xy_ * xz_ - xx * yz_, c_zz = xx * yy - xy_ * xy_;
  const double determinant = xx * c_xx + xy_ * c_xy + xz_ * c_xz;
  if (!(determinant > 0)) return {};
  return {(c_xx * x_ + c_xy * y_ + c_xz * z_) / determinant,
          (c_xy * x_ + c_yy * y_ + c_yz * z_) / determinant,
          (c_xz * x_ + c_yz * y_ + c_zz * z_) / determinant};
}

}  // namespace pointreel
