#include "sensor/polar_points.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "base/simd_loops.h"
#include "base/trigonometry.h"

namespace pointreel {

namespace {

// q = R(s w) p + s v, with s from the azimuth of q itself. Two rounds from the azimuth of p leave an error of
// (v / 2 pi rho)^2 of the shift, a third removes it. Float: micrometres, 80 m away.
inline void undo_motion(const Twist& twist, std::span<float> xs, std::span<float> ys, std::span<float> zs) {
  const auto& w = twist.w_rad;
  const double angle = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const double k = angle > 0 ? 1 / angle : 0;
  const auto ax = static_cast<float>(w[0] * k);
  const auto ay = static_cast<float>(w[1] * k);
  const auto az = static_cast<float>(w[2] * k);
  const auto vx = static_cast<float>(twist.v_m[0]);
  const auto vy = static_cast<float>(twist.v_m[1]);
  const auto vz = static_cast<float>(twist.v_m[2]);
  const auto angle_rad = static_cast<float>(angle);
  constexpr auto kTurnsPerRad = static_cast<float>(1 / kTurn);
  float* px = xs.data();
  float* py = ys.data();
  float* pz = zs.data();
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const float x = px[i];
    const float y = py[i];
    const float z = pz[i];
    const float along = ax * x + ay * y + az * z;
    float qx = x;
    float qy = y;
    float qz = z;
    for (int round = 0; round < 3; ++round) {
      const float s = fast_atan2(qy, qx) * kTurnsPerRad;
      const float t = s * angle_rad;  // below pi for any sane sweep
      const float t2 = t * t;
      const float sine = t * (1 - t2 * (1.0F / 6) * (1 - t2 * (1.0F / 20) * (1 - t2 * (1.0F / 42))));
      const float versine =
          t2 * 0.5F * (1 - t2 * (1.0F / 12) * (1 - t2 * (1.0F / 30) * (1 - t2 * (1.0F / 56))));
      qx = x + (sine * (ay * z - az * y) + versine * (along * ax - x) + s * vx);
      qy = y + (sine * (az * x - ax * z) + versine * (along * ay - y) + s * vy);
      qz = z + (sine * (ax * y - ay * x) + versine * (along * az - z) + s * vz);
    }
    px[i] = qx;
    py[i] = qy;
    pz[i] = qz;
  }
}

// Those in [from, last), in blocks of separate coordinates.
POINTREEL_SIMD_LOOPS void fill_piece(const PointCloud& cloud, const std::optional<Twist>& motion,
                                     std::size_t from, std::size_t last, PolarPoints& polar) {
  constexpr std::size_t kBlock = 256;
  float x[kBlock], y[kBlock], z[kBlock];
  for (std::size_t first = from; first < last; first += kBlock) {
    const std::size_t block = std::min(kBlock, last - first);
    for (std::size_t k = 0; k < block; ++k) {
      x[k] = cloud.positions[first + k].x;
      y[k] = cloud.positions[first + k].y;
      z[k] = cloud.positions[first + k].z;
    }
    if (motion)
      undo_motion(*motion, std::span(x).first(block), std::span(y).first(block), std::span(z).first(block));
    float* rhos_m = &polar.rho_m[first];
    float* azimuths_rad = &polar.azimuth_rad[first];
    float* zs_m = &polar.z_m[first];
    for (std::size_t k = 0; k < block; ++k) {
      const float rho = std::sqrt(x[k] * x[k] + y[k] * y[k]);
      // False for NaN.
      const bool usable = (rho >= kLeastRhoM) & (rho <= kMostRhoM) & (std::fabs(z[k]) <= kMostRhoM);
      rhos_m[k] = usable ? rho : 0.0F;
      zs_m[k] = usable ? z[k] : 0.0F;
      const float azimuth = fast_atan2(y[k], x[k]);
      azimuths_rad[k] = usable ? azimuth : 0.0F;
    }
  }
}

}  // namespace

PolarPoints polar_points(const PointCloud& cloud, const std::optional<Twist>& motion, int threads) {
  const std::size_t count = cloud.size();
  PolarPoints polar;
  polar.rho_m.resize(count);
  polar.azimuth_rad.resize(count);
  polar.z_m.resize(count);
  for_each_piece(count, threads, [&](std::size_t, std::size_t first, std::size_t last) {
    fill_piece(cloud, motion, first, last, polar);
  });
  return polar;
}

}  // namespace pointreel
