// Poses, IMU samples and the files they come in. Frames: world = any fixed frame, sensor = LiDAR, x forward,
// y left, z up. T_a_b takes coordinates in b to coordinates in a.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "pointreel/result.h"

namespace pointreel {

using Pose = Eigen::Isometry3d;

struct TimedPose {
  double time_s = 0;
  Pose T_world_sensor = Pose::Identity();
};

// One reading in sensor axes. Accelerations may contain gravity (as real accelerometers measure it).
struct ImuSample {
  double time_s = 0;
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rate_radps = Eigen::Vector3d::Zero();
  // Measured velocity in sensor axes when the unit has one (GPS/IMU, odometry); integrated when absent.
  std::optional<Eigen::Vector3d> velocity_mps;
};

// --- files ---
// Errors name file and line: io_error, corrupt (also times that do not increase), truncated where nothing is
// in the file, resource_limit. Empty lines and lines that start with # are skipped.

// KITTI: one 3x4 row-major matrix T_world_sensor a line. No times. A rounded rotation is made orthonormal;
// one whose elements are more than 0.002 off a rotation is corrupt.
Result<std::vector<Pose>> read_kitti_poses(const std::filesystem::path& path);
Result<void> write_kitti_poses(const std::filesystem::path& path, std::span<const Pose> T_world_sensor);
// TUM: "time tx ty tz qx qy qz qw" a line.
Result<std::vector<TimedPose>> read_tum_poses(const std::filesystem::path& path);
// CSV: t, ax, ay, az, wx, wy, wz[, vx, vy, vz] in s, m/s^2, rad/s, m/s; an optional header line in any
// wording, but these names in another order are corrupt. Writing and reading keeps every bit.
Result<std::vector<ImuSample>> read_imu_csv(const std::filesystem::path& path);
Result<void> write_imu_csv(const std::filesystem::path& path, std::span<const ImuSample> samples);
// KITTI oxts folder: timestamps.txt and data/*.txt (30 values a file; the number in a file's name is its line
// of timestamps.txt, from 0). Times are seconds since the first sample. vf, vl, vu, tilted by roll and pitch,
// become velocity_mps. The folder's sibling calib_imu_to_velo.txt, or one in a parent folder up to two levels
// up, turns the readings into the LiDAR's axes where it exists, and makes velocity_mps that of the LiDAR's
// place.
Result<std::vector<ImuSample>> read_kitti_oxts(const std::filesystem::path& folder);

// --- IMU integration (the paper's first-order scheme) ---

struct ImuIntegrationOptions {
  Eigen::Vector3d initial_velocity_mps = Eigen::Vector3d::Zero();  // used when samples carry no velocity
  // Gravity and gyro bias: averaged over this lead-in where the IMU stands still (no rotation, |a|
  // about 9.81); without such a lead-in gravity is taken from the mean acceleration when that is near 9.81,
  // and no bias.
  double stationary_s = 0.5;  // 0: no lead-in
};

// Dead reckoning: v' = v + (a + a')/2 dt, dx = (v + v')/2 dt, the same for the angles, giving the sensor's
// pose at every sample in the frame of the first. A sample's velocity_mps replaces v'. Error:
// invalid_argument when there are no samples, times do not increase or a number is not finite.
Result<std::vector<TimedPose>> integrate_imu(std::span<const ImuSample> samples,
                                             const ImuIntegrationOptions& options = {});

// Pose at a time: linear in translation, slerp in rotation, clamped to the ends. `track` is sorted, not
// empty.
Pose interpolate_pose(std::span<const TimedPose> track, double time_s);

}  // namespace pointreel
