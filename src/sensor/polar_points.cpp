#include "sensor/polar_points.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/trigonometry.h"

namespace pointreel {

// Two rounds from the azimuth of p leave an error of (v / 2 pi rho)^2 of the shift, a third removes it.
Point3f as_measured(const Point3f& p, const Twist& twist) {
  const auto& v = twist.v_m;
  const auto& w = twist.w_rad;
  const double angle = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const double k = angle > 0 ? 1 / angle : 0;
  const double a[3] = {w[0] * k, w[1] * k, w[2] * k};
  const double x = p.x;
  const double y = p.y;
  const double z = p.z;
  const double along = a[0] * x + a[1] * y + a[2] * z;
  double qx = x;
  double qy = y;
  double qz = z;
  for (int round = 0; round < 3; ++round) {
    const double s =
        static_cast<double>(fast_atan2(static_cast<float>(qy), static_cast<float>(qx))) / (2 * kPi);
    const double t = s * angle;  // below pi for any sane sweep
    const double t2 = t * t;
    const double sine = t * (1 - t2 * (1.0 / 6) * (1 - t2 * (1.0 / 20) * (1 - t2 * (1.0 / 42))));
    const double versine = t2 * 0.5 * (1 - t2 * (1.0 / 12) * (1 - t2 * (1.0 / 30) * (1 - t2 * (1.0 / 56))));
    const double cosine = 1 - versine;
    qx = cosine * x + sine * (a[1] * z - a[2] * y) + versine * along * a[0] + s * v[0];
    qy = cosine * y + sine * (a[2] * x - a[0] * z) + versine * along * a[1] + s * v[1];
    qz = cosine * z + sine * (a[0] * y - a[1] * x) + versine * along * a[2] + s * v[2];
  }
  return {static_cast<float>(qx), static_cast<float>(qy), static_cast<float>(qz)};
}

PolarPoints polar_points(const PointCloud& cloud, const std::optional<Twist>& motion, int threads) {
  const std::size_t count = cloud.size();
  PolarPoints polar;
  polar.rho_m.resize(count);
  polar.azimuth_rad.resize(count);
  polar.z_m.resize(count);
  const std::size_t pieces = (count + kPiecePoints - 1) / kPiecePoints;
  parallel_for(pieces, threads, [&](std::size_t piece) {
    const std::size_t last = std::min(count, (piece + 1) * kPiecePoints);
    const auto convert = [&](std::size_t i, const Point3f& q) {
      const float rho = std::sqrt(q.x * q.x + q.y * q.y);
      // False for NaN.
      const bool usable = rho >= kLeastRhoM && rho <= kMostRhoM && std::fabs(q.z) <= kMostRhoM;
      polar.rho_m[i] = usable ? rho : 0.0F;
      polar.azimuth_rad[i] = usable ? fast_atan2(q.y, q.x) : 0.0F;
      polar.z_m[i] = usable ? q.z : 0.0F;
    };
    if (motion) {
      for (std::size_t i = piece * kPiecePoints; i < last; ++i)
        convert(i, as_measured(cloud.positions[i], *motion));
    } else {
      for (std::size_t i = piece * kPiecePoints; i < last; ++i) convert(i, cloud.positions[i]);
    }
  });
  return polar;
}

}  // namespace pointreel
