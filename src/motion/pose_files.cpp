// Pose files of the KITTI and TUM kinds.
#include <cmath>

#include "motion/rotation.h"
#include "motion/text_lines.h"
#include "pointreel/motion.h"

namespace pointreel {
namespace {

Result<Pose> parse_kitti_pose(const TextLine& line) {
  const auto numbers = parse_numbers(line, Separator::blanks, 12);
  if (!numbers) return numbers.error();
  const std::optional<Pose> T_world_sensor = pose_from_matrix(Eigen::Map<const Matrix34>(numbers->data()));
  if (!T_world_sensor) return line.error("the left 3x3 of the matrix is not a rotation");
  return *T_world_sensor;
}

Result<TimedPose> parse_tum_pose(const TextLine& line) {
  const auto numbers = parse_numbers(line, Separator::blanks, 8);
  if (!numbers) return numbers.error();
  const std::vector<double>& n = *numbers;
  const Eigen::Quaterniond q(n[7], n[4], n[5], n[6]);
  constexpr double kMaxNormDeviation = 0.01;  // three decimals a component, and some
  if (!(std::abs(q.norm() - 1) <= kMaxNormDeviation)) return line.error("the quaternion is not of length 1");
  TimedPose pose;
  pose.time_s = n[0];
  pose.T_world_sensor.linear() = q.normalized().toRotationMatrix();
  pose.T_world_sensor.translation() = Eigen::Vector3d(n[1], n[2], n[3]);
  return pose;
}

}  // namespace

Result<std::vector<Pose>> read_kitti_poses(const std::filesystem::path& path) {
  std::vector<Pose> poses;
  const auto read = for_each_line(path, [&](const TextLine& line) -> Result<void> {
    auto pose = parse_kitti_pose(line);
    if (!pose) return pose.error();
    poses.push_back(*pose);
    return {};
  });
  if (!read) return read.error();
  if (poses.empty()) return file_error(ErrorCode::truncated, path, "holds no poses");
  return poses;
}

Result<void> write_kitti_poses(const std::filesystem::path& path, std::span<const Pose> T_world_sensor) {
  std::string text;
  for (const Pose& pose : T_world_sensor) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        append_number(text, pose(row, column));
        text += row == 2 && column == 3 ? '\n' : ' ';
      }
    }
  }
  return write_text_file(path, text);
}

Result<std::vector<TimedPose>> read_tum_poses(const std::filesystem::path& path) {
  std::vector<TimedPose> poses;
  const auto read = for_each_line(path, [&](const TextLine& line) -> Result<void> {
    auto pose = parse_tum_pose(line);
    if (!pose) return pose.error();
    if (!poses.empty() && pose->time_s <= poses.back().time_s) {
      return line.error("the time is not after that of the pose before");
    }
    poses.push_back(*pose);
    return {};
  });
  if (!read) return read.error();
  if (poses.empty()) return file_error(ErrorCode::truncated, path, "holds no poses");
  return poses;
}

}  // namespace pointreel
