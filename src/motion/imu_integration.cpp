// Dead reckoning of the paper's section "Temporal Encoding": acceleration and rotation rate integrated with
// the mean of two neighbouring samples. Angles are kept as a rotation matrix, not as the paper's three
// angles, which add up only while they are small.
#include <algorithm>
#include <cmath>

#include "pointreel/motion.h"

namespace pointreel {
namespace {

constexpr double kStandardGravity_mps2 = 9.81;
constexpr double kGravityTolerance_mps2 = 0.5;  // bias and scale of a cheap accelerometer
constexpr double kStillSpeed_mps = 0.05;
constexpr double kMaxGyroBias_radps = 0.03;  // 1.7 deg/s; a steady rate above is a turn
constexpr double kStillRateSpread_radps = 0.03;
constexpr double kStillAccelerationSpread_mps2 = 0.5;
constexpr std::size_t kMinLeadInSamples = 5;

struct ImuOffsets {
  Eigen::Vector3d gravity_mps2 =
      Eigen::Vector3d::Zero();  // what the accelerometer shows at rest, start frame
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
};

struct MeanAndSpread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double spread = 0;  // root mean square distance from the mean
};

MeanAndSpread mean_and_spread(std::span<const ImuSample> samples, Eigen::Vector3d ImuSample::*value) {
  MeanAndSpread result;
  for (const ImuSample& sample : samples) result.mean += sample.*value;
  result.mean /= static_cast<double>(samples.size());
  double squares = 0;
  for (const ImuSample& sample : samples) squares += (sample.*value - result.mean).squaredNorm();
  result.spread = std::sqrt(squares / static_cast<double>(samples.size()));
  return result;
}

bool is_gravity(const Eigen::Vector3d& acceleration_mps2) {
  return std::abs(acceleration_mps2.norm() - kStandardGravity_mps2) <= kGravityTolerance_mps2;
}

// Offsets from the samples of the first `stationary_s`, where the unit stood still all that time.
std::optional<ImuOffsets> offsets_at_rest(std::span<const ImuSample> samples,
                                          const ImuIntegrationOptions& options) {
  const double end_s = samples.front().time_s + options.stationary_s;
  if (!(options.stationary_s > 0) || samples.back().time_s < end_s) return std::nullopt;
  const auto end = std::find_if(samples.begin(), samples.end(),
                                [&](const ImuSample& sample) { return sample.time_s > end_s; });
  const auto lead_in = samples.first(static_cast<std::size_t>(end - samples.begin()));
  if (lead_in.size() < kMinLeadInSamples) return std::nullopt;

  // Driving straight at a steady speed looks like rest to an IMU, so ask the velocities first.
  const bool moving = std::any_of(lead_in.begin(), lead_in.end(), [&](const ImuSample& sample) {
    return sample.velocity_mps.value_or(options.initial_velocity_mps).norm() > kStillSpeed_mps;
  });
  const auto acceleration = mean_and_spread(lead_in, &ImuSample::acceleration_mps2);
  const auto rate = mean_and_spread(lead_in, &ImuSample::rotation_rate_radps);
  if (moving || !is_gravity(acceleration.mean) || acceleration.spread > kStillAccelerationSpread_mps2 ||
      rate.mean.norm() > kMaxGyroBias_radps || rate.spread > kStillRateSpread_radps) {
    return std::nullopt;
  }
  return ImuOffsets{acceleration.mean, rate.mean};
}

Eigen::Matrix3d rotation_from_vector(const Eigen::Vector3d& angle_rad) {
  const double angle = angle_rad.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, angle_rad / angle).toRotationMatrix();
}

// Orientation at every sample in the frame of the first.
std::vector<Eigen::Quaterniond> integrate_rotation(std::span<const ImuSample> samples,
                                                   const Eigen::Vector3d& gyro_bias_radps) {
  std::vector<Eigen::Quaterniond> q_start_sensor{Eigen::Quaterniond::Identity()};
  q_start_sensor.reserve(samples.size());
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double dt = samples[k].time_s - samples[k - 1].time_s;
    const Eigen::Vector3d mean_rate =
        (samples[k - 1].rotation_rate_radps + samples[k].rotation_rate_radps) / 2 - gyro_bias_radps;
    const Eigen::Quaterniond step(rotation_from_vector(mean_rate * dt));
    q_start_sensor.push_back((q_start_sensor.back() * step).normalized());
  }
  return q_start_sensor;
}

// Over a drive the accelerations of the vehicle cancel: what remains in the start frame is gravity, if any.
Eigen::Vector3d gravity_from_mean(std::span<const ImuSample> samples,
                                  std::span<const Eigen::Quaterniond> q_start_sensor) {
  Eigen::Vector3d speed_change_mps = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const Eigen::Vector3d before = q_start_sensor[k - 1] * samples[k - 1].acceleration_mps2;
    const Eigen::Vector3d after = q_start_sensor[k] * samples[k].acceleration_mps2;
    speed_change_mps += (before + after) / 2 * (samples[k].time_s - samples[k - 1].time_s);
  }
  const Eigen::Vector3d mean_mps2 = speed_change_mps / (samples.back().time_s - samples.front().time_s);
  return is_gravity(mean_mps2) ? mean_mps2 : Eigen::Vector3d::Zero();
}

Result<void> check(std::span<const ImuSample> samples) {
  if (samples.empty()) return Error{ErrorCode::invalid_argument, "there are no IMU samples to integrate"};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const ImuSample& sample = samples[k];
    if (!std::isfinite(sample.time_s) || !sample.acceleration_mps2.allFinite() ||
        !sample.rotation_rate_radps.allFinite() ||
        (sample.velocity_mps && !sample.velocity_mps->allFinite())) {
      return Error{ErrorCode::invalid_argument,
                   "IMU sample " + std::to_string(k) + " holds a number that is not finite"};
    }
    if (k > 0 && sample.time_s <= samples[k - 1].time_s) {
      return Error{ErrorCode::invalid_argument,
                   "the time of IMU sample " + std::to_string(k) + " is not after that of the one before"};
    }
  }
  return {};
}

}  // namespace

Result<std::vector<TimedPose>> integrate_imu(std::span<const ImuSample> samples,
                                             const ImuIntegrationOptions& options) {
  if (const auto checked = check(samples); !checked) return checked.error();

  const std::optional<ImuOffsets> at_rest = offsets_at_rest(samples, options);
  const ImuOffsets offsets = at_rest.value_or(ImuOffsets{});
  const auto q_start_sensor = integrate_rotation(samples, offsets.gyro_bias_radps);
  const Eigen::Vector3d gravity_mps2 =
      at_rest ? offsets.gravity_mps2 : gravity_from_mean(samples, q_start_sensor);

  const auto acceleration = [&](std::size_t k) -> Eigen::Vector3d {
    return q_start_sensor[k] * samples[k].acceleration_mps2 - gravity_mps2;
  };
  Eigen::Vector3d velocity_mps = samples[0].velocity_mps.value_or(options.initial_velocity_mps);
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();

  std::vector<TimedPose> track;
  track.reserve(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) {
      const double dt = samples[k].time_s - samples[k - 1].time_s;
      const Eigen::Vector3d last_velocity_mps = velocity_mps;
      if (samples[k].velocity_mps) {
        velocity_mps = q_start_sensor[k] * *samples[k].velocity_mps;
      } else {
        velocity_mps += (acceleration(k - 1) + acceleration(k)) / 2 * dt;
      }
      position_m += (last_velocity_mps + velocity_mps) / 2 * dt;
    }
    TimedPose& pose = track.emplace_back();
    pose.time_s = samples[k].time_s;
    pose.T_world_sensor.linear() = q_start_sensor[k].toRotationMatrix();
    pose.T_world_sensor.translation() = position_m;
  }
  return track;
}

}  // namespace pointreel
