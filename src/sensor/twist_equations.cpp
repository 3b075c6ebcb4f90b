#include "sensor/twist_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/trigonometry.h"

namespace pointreel {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;  // v, w
using Matrix6 = Eigen::Matrix<double, 6, 6>;

void add(Twist& twist, const Vector6& change) {
  for (int k = 0; k < 3; ++k) {
    twist.v_m[static_cast<std::size_t>(k)] =
        std::clamp(twist.v_m[static_cast<std::size_t>(k)] + change[k], -8.0, 8.0);
    twist.w_rad[static_cast<std::size_t>(k)] =
        std::clamp(twist.w_rad[static_cast<std::size_t>(k)] + change[k + 3], -1.0, 1.0);
  }
}

// Change of a point's height above its row, and of its place across the ray, with the twist.
Vector6 height_gradient(const RowModel& row, double s, double rho, double cos_a, double sin_a, double z) {
  Vector6 g;
  g << -row.slope * cos_a, -row.slope * sin_a, 1, rho * sin_a + row.slope * z * sin_a,
      -rho * cos_a - row.slope * z * cos_a, 0;
  return s * g;
}
Vector6 side_gradient(double s, double rho, double cos_a, double sin_a, double z) {
  Vector6 g;
  g << -sin_a, cos_a, 0, -z * cos_a, -z * sin_a, rho;
  return s * g;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Normal equations of the twist, with a line of each row (a constant and a share of rho) estimated beside it
// and eliminated, or left as it is.
class TwistEquations {
 public:
  explicit TwistEquations(bool rows_free) : rows_free_(rows_free) {}

  void begin_row() {
    cross_.setZero();
    own_.setZero();
    own_right_.setZero();
  }
  void add(const Vector6& gradient, const Eigen::Vector2d& line, double residual, double weight) {
    matrix_ += weight * gradient * gradient.transpose();
    right_ -= weight * residual * gradient;
    if (!rows_free_) return;
    cross_ += weight * gradient * line.transpose();
    own_ += weight * line * line.transpose();
    own_right_ -= weight * residual * line;
  }
  void end_row() {
    if (!rows_free_) return;
    const Eigen::Matrix2d damped = own_ + 1e-9 * (1 + own_.trace()) * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d inverse = damped.inverse();
    matrix_ -= cross_ * inverse * cross_.transpose();
    right_ -= cross_ * inverse * own_right_;
  }
  void join(const TwistEquations& other) {
    matrix_ += other.matrix_;
    right_ += other.right_;
  }
  Vector6 solve() const {
    const Matrix6 damped = matrix_ + 1e-7 * (1e-3 + matrix_.trace()) * Matrix6::Identity();
    return damped.ldlt().solve(right_);
  }

 private:
  bool rows_free_;
  Matrix6 matrix_ = Matrix6::Zero();
  Vector6 right_ = Vector6::Zero();
  Eigen::Matrix<double, 6, 2> cross_;
  Eigen::Matrix2d own_;
  Eigen::Vector2d own_right_;
};

// Distance from the nearest multiple of a tick.
double from_tick(double azimuth_rad, double tick_rad) {
  return azimuth_rad - tick_rad * std::floor(azimuth_rad / tick_rad + 0.5);
}

}  // namespace

TwistStep improve(const TwistSamples& samples, const std::vector<RowModel>& rows, const TwistTarget& target,
                  Twist& twist) {
  const PolarPoints polar = polar_points(samples.cloud, twist, 1);
  std::vector<double> heights_m(samples.size());
  std::vector<double> misfits_m(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const RowModel& row = rows[samples.row[i]];
    heights_m[i] = polar.z_m[i] - row.slope * polar.rho_m[i] - row.offset_m;
    misfits_m[i] = std::fabs(heights_m[i]);
  }
  const double scatter_m = median(std::move(misfits_m));
  const double limit_m = std::max(6 * scatter_m, 2e-3);
  const double tick_rad = target.ticks_per_turn > 0 ? kTurn / target.ticks_per_turn : 0;
  TwistEquations up(target.rows_free);
  TwistEquations across(target.rows_free);
  for (std::size_t first = 0; first < samples.size();) {
    std::size_t last = first;
    while (last < samples.size() && samples.row[last] == samples.row[first]) ++last;
    const RowModel& row = rows[samples.row[first]];
    up.begin_row();
    across.begin_row();
    for (std::size_t i = first; i < last; ++i) {
      const double t = heights_m[i] / limit_m;
      if (!polar.has_ray(i) || std::fabs(t) > 1) continue;
      const double rho = polar.rho_m[i];
      const double azimuth = polar.azimuth_rad[i];
      const double s = azimuth / kTurn;
      const auto cos_a = static_cast<double>(std::cos(polar.azimuth_rad[i]));
      const auto sin_a = static_cast<double>(std::sin(polar.azimuth_rad[i]));
      const double z = polar.z_m[i];
      up.add(height_gradient(row, s, rho, cos_a, sin_a, z), {-rho, -1}, heights_m[i],
             (1 - t * t) * (1 - t * t));
      if (tick_rad == 0 || rho < 1.5) continue;
      const double away = from_tick(azimuth - row.azimuth_rad - std::atan(row.side_offset_m / rho), tick_rad);
      if (std::fabs(away) > 0.3 * tick_rad) continue;
      across.add(side_gradient(s, rho, cos_a, sin_a, z), {rho, 1}, away * rho, 1);
    }
    up.end_row();
    across.end_row();
    first = last;
  }
  up.join(across);
  Vector6 change = up.solve();
  if (!change.allFinite()) return {scatter_m, 0};
  if (tick_rad == 0) change[5] = 0;
  add(twist, change);
  return {scatter_m, change.cwiseAbs().maxCoeff()};
}

Twist rounded(Twist twist) {
  for (auto* values : {&twist.v_m, &twist.w_rad}) {
    for (double& value : *values) value = std::nearbyint(value / kTwistStep) * kTwistStep;
  }
  return twist;
}

}  // namespace pointreel
