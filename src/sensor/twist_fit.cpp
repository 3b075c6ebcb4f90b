#include "sensor/twist_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensor/polar_points.h"
#include "sensor/row_fit.h"

namespace pointreel {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
using Vector6 = Eigen::Matrix<double, 6, 1>;  // v, w
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct Sample {
  Point3f p;
  std::uint32_t row;
};

// The samples as measured under a twist.
PolarPoints measured(const std::vector<Sample>& samples, const Twist& twist) {
  PointCloud cloud;
  cloud.positions.reserve(samples.size());
  for (const Sample& sample : samples) cloud.positions.push_back(sample.p);
  return polar_points(cloud, twist, 1);
}

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

// A round of Gauss-Newton; the samples are sorted by row. Ticks are looked at when `ticks_per_turn` is given.
// Returns the median distance from the rows' lines before it.
double improve(const std::vector<Sample>& samples, const std::vector<RowModel>& rows,
               std::uint32_t ticks_per_turn, bool rows_free, Twist& twist) {
  const PolarPoints polar = measured(samples, twist);
  const auto height = [&](std::size_t i) {
    const RowModel& row = rows[samples[i].row];
    return polar.z_m[i] - row.slope * polar.rho_m[i] - row.offset_m;
  };
  std::vector<double> misfits(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) misfits[i] = std::fabs(height(i));
  const double scatter = median(misfits);
  const double limit = std::max(6 * scatter, 2e-3);
  const double tick = ticks_per_turn > 0 ? kTurn / ticks_per_turn : 0;
  TwistEquations equations(rows_free);
  for (std::size_t first = 0; first < samples.size();) {
    std::size_t last = first;
    while (last < samples.size() && samples[last].row == samples[first].row) ++last;
    const RowModel& row = rows[samples[first].row];
    for (const bool across : {false, true}) {
      if (across && tick == 0) continue;
      equations.begin_row();
      for (std::size_t i = first; i < last; ++i) {
        if (!polar.has_ray(i)) continue;
        const double rho = polar.rho_m[i];
        const double azimuth = polar.azimuth_rad[i];
        const double s = azimuth / kTurn;
        const double cos_a = std::cos(azimuth);
        const double sin_a = std::sin(azimuth);
        const double z = polar.z_m[i];
        double residual = height(i);
        if (std::fabs(residual) > limit) continue;
        const double t = residual / limit;
        double weight = (1 - t * t) * (1 - t * t);
        if (across) {
          const double away =
              std::remainder(azimuth - row.azimuth_rad - std::atan(row.side_offset_m / rho), tick);
          if (std::fabs(away) > 0.3 * tick || rho < 1.5) continue;
          residual = away * rho;
          weight = 1;
          equations.add(side_gradient(s, rho, cos_a, sin_a, z), {rho, 1}, residual, weight);
        } else {
          equations.add(height_gradient(row, s, rho, cos_a, sin_a, z), {-rho, -1}, residual, weight);
        }
      }
      equations.end_row();
    }
    first = last;
  }
  Vector6 change = equations.solve();
  if (!change.allFinite()) return scatter;
  if (tick == 0) change[5] = 0;  // heights do not tell the yaw
  add(twist, change);
  return scatter;
}

// Slope and offset of every row from the samples as measured.
void fit_lines(const std::vector<Sample>& samples, const Twist& twist, std::vector<RowModel>& rows) {
  const PolarPoints polar = measured(samples, twist);
  RowPoints points(rows.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (polar.has_ray(i)) points[samples[i].row].push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const RowFit fit = fit_row(polar, points[r]);
    if (!fit.usable) continue;
    rows[r].slope = fit.slope;
    rows[r].offset_m = fit.offset_m;
  }
}

// The number of ticks that neighbours in a row tell: a fraction, since the yaw stretches all azimuths.
double stretched_ticks_per_turn(const PointCloud& cloud, const RowPoints& rows, const Twist& twist) {
  constexpr std::size_t kMostLag = 5;
  constexpr float kSameM = 3e-4F;  // of 1 / rho: side offsets then move both points alike
  std::vector<double> differences;
  const PolarPoints polar = polar_points(cloud, twist, 1);
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      for (std::size_t lag = 1; lag <= kMostLag && k + lag < row.size(); ++lag) {
        const std::uint32_t a = row[k];
        const std::uint32_t b = row[k + lag];
        if (polar.rho_m[a] < 6 || polar.rho_m[b] < 6) continue;
        if (std::fabs(1 / polar.rho_m[a] - 1 / polar.rho_m[b]) > kSameM) continue;
        const double d =
            static_cast<double>(polar.azimuth_rad[b]) - static_cast<double>(polar.azimuth_rad[a]);
        if (std::fabs(d) > 1e-4 && std::fabs(d) < 0.06) differences.push_back(std::fabs(d));
      }
    }
  }
  if (differences.size() < 500) return 0;
  std::vector<double> few;
  for (std::size_t k = 0; k < differences.size(); k += differences.size() / 1500 + 1)
    few.push_back(differences[k]);
  const auto score = [](const std::vector<double>& all, double n) {
    double sum = 0;
    for (const double d : all) sum += std::cos(n * d);
    return sum / static_cast<double>(all.size());
  };
  constexpr double kFewest = 300;
  constexpr double kStep = 8;
  std::vector<double> scores;
  for (double n = kFewest; n < 12000; n += kStep) scores.push_back(score(few, n));
  const double best = *std::max_element(scores.begin(), scores.end());
  if (best < 0.4) return 0;
  for (std::size_t k = 1; k + 1 < scores.size(); ++k) {
    if (scores[k] < 0.8 * best || scores[k] < scores[k - 1] || scores[k] < scores[k + 1]) continue;
    double n = kFewest + kStep * static_cast<double>(k);
    for (double step = kStep / 2; step > 0.02; step /= 2) {
      const double here = score(differences, n);
      const double up = score(differences, n + step);
      const double down = score(differences, n - step);
      if (up > here && up >= down)
        n += step;
      else if (down > here)
        n -= step;
    }
    return n;
  }
  return 0;
}

// The roundest number within what a sane yaw (0.1 rad a sweep) may have stretched.
std::uint32_t round_ticks(double stretched) {
  const double reach = stretched * 0.1 / kTurn;
  for (const double unit : {1000.0, 900.0, 512.0, 400.0, 360.0, 100.0, 10.0}) {
    const double nearest = std::nearbyint(stretched / unit) * unit;
    if (nearest > 0 && std::fabs(nearest - stretched) <= reach) return static_cast<std::uint32_t>(nearest);
  }
  return static_cast<std::uint32_t>(std::nearbyint(stretched));
}

Twist rounded(Twist twist) {
  for (auto* values : {&twist.v_m, &twist.w_rad}) {
    for (double& value : *values) value = std::nearbyint(value / kTwistStep) * kTwistStep;
  }
  return twist;
}

}  // namespace

std::optional<BlindTwist> find_twist_blind(const PointCloud& cloud, const RowPoints& rows) {
  constexpr std::size_t kSamplesPerRow = 400;
  constexpr int kHeightRounds = 8;
  constexpr int kJointRounds = 5;
  std::vector<Sample> samples;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::size_t stride = rows[r].size() / kSamplesPerRow + 1;
    for (std::size_t k = 0; k < rows[r].size(); k += stride)
      samples.push_back({cloud.positions[rows[r][k]], static_cast<std::uint32_t>(r)});
  }
  if (samples.empty()) return {};
  BlindTwist found;
  std::vector<RowModel> lines(rows.size());
  for (int round = 0; round < kHeightRounds; ++round) {
    fit_lines(samples, found.twist, lines);
    found.scatter_m = improve(samples, lines, 0, true, found.twist);
  }
  const double stretched = stretched_ticks_per_turn(cloud, rows, found.twist);
  if (stretched == 0) return {};
  found.ticks_per_turn = round_ticks(stretched);
  found.twist.w_rad[2] = kTurn * (stretched / found.ticks_per_turn - 1);
  for (int round = 0; round < kJointRounds; ++round) {
    fit_lines(samples, found.twist, lines);
    const PolarPoints polar = measured(samples, found.twist);
    RowPoints points(rows.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (polar.has_ray(i)) points[samples[i].row].push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const RowAzimuth fit = fit_row_azimuth(polar, points[r], found.ticks_per_turn);
      lines[r].azimuth_rad = fit.phase_rad;
      lines[r].side_offset_m = fit.side_offset_m;
    }
    found.scatter_m = improve(samples, lines, found.ticks_per_turn, true, found.twist);
  }
  found.twist = rounded(found.twist);
  return found;
}

Twist find_twist(const SensorModel& model, const PointCloud& cloud, const std::vector<std::int16_t>& rows) {
  constexpr std::size_t kSamples = 3000;
  std::vector<Sample> samples;
  const std::size_t stride = cloud.size() / kSamples + 1;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    const Point3f& p = cloud.positions[i];
    if (rows[i] >= 0) samples.push_back({p, static_cast<std::uint32_t>(rows[i])});
  }
  Twist twist;
  if (samples.size() < 50) return twist;
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.row < b.row; });
  for (int round = 0; round < 4; ++round) improve(samples, model.rows, 0, false, twist);
  if (model.ticks_per_turn > 0) {
    // The yaw that puts most points on ticks, first coarsely.
    const PolarPoints polar = measured(samples, twist);
    const double n = model.ticks_per_turn;
    constexpr double kMostYaw = 0.2;
    const double step = 1.5 / n;
    std::vector<float> re, im, step_re, step_im;
    for (std::size_t i = 0; i < samples.size(); i += 2) {
      const double rho = polar.rho_m[i];
      if (rho < 4) continue;
      const RowModel& row = model.rows[samples[i].row];
      const double azimuth = polar.azimuth_rad[i];
      const double phase =
          n * (azimuth - row.azimuth_rad - std::atan(row.side_offset_m / rho) - azimuth / kTurn * kMostYaw);
      const double turn = n * azimuth / kTurn * step;
      re.push_back(static_cast<float>(std::cos(phase)));
      im.push_back(static_cast<float>(std::sin(phase)));
      step_re.push_back(static_cast<float>(std::cos(turn)));
      step_im.push_back(static_cast<float>(std::sin(turn)));
    }
    float most = -1;
    const int steps = static_cast<int>(2 * kMostYaw / step);
    for (int k = 0; k <= steps; ++k) {
      float sum = 0;
      for (std::size_t i = 0; i < re.size(); ++i) {
        sum += re[i];
        const float next = re[i] * step_re[i] - im[i] * step_im[i];
        im[i] = re[i] * step_im[i] + im[i] * step_re[i];
        re[i] = next;
      }
      if (sum > most) {
        most = sum;
        twist.w_rad[2] = -kMostYaw + k * step;
      }
    }
    for (int round = 0; round < 4; ++round) improve(samples, model.rows, model.ticks_per_turn, false, twist);
  }
  return rounded(twist);
}

}  // namespace pointreel
