#include "common/motion_input.h"

#include <fstream>
#include <sstream>
#include <string>

namespace pointreel {
namespace {

constexpr double kDefaultSweepInterval_s = 0.1;

Error count_mismatch(const std::filesystem::path& file, std::size_t have, std::size_t sweeps) {
  return {ErrorCode::invalid_argument, file.string() + ": holds " + std::to_string(have) + " entries for " +
                                           std::to_string(sweeps) + " sweeps"};
}

Result<std::vector<Pose>> poses_at(std::span<const TimedPose> track, const std::filesystem::path& file,
                                   std::span<const std::filesystem::path> sweeps) {
  const auto times = sweep_times(sweeps);
  if (!times) return times.error();
  // Half a sweep of slack at either end: clamping there is harmless, matching another drive's times is not.
  const double slack_s = kDefaultSweepInterval_s / 2;
  if (times->front() < track.front().time_s - slack_s || times->back() > track.back().time_s + slack_s) {
    return Error{ErrorCode::invalid_argument,
                 file.string() + ": covers " + std::to_string(track.front().time_s) + " to " +
                     std::to_string(track.back().time_s) + " s but the sweeps run from " +
                     std::to_string(times->front()) + " to " + std::to_string(times->back()) +
                     " s (times.txt beside them says otherwise?)"};
  }
  std::vector<Pose> poses;
  for (const double time_s : *times) poses.push_back(interpolate_pose(track, time_s));
  return poses;
}

// Numbers on the first line that is not a comment.
std::size_t numbers_per_line(const std::filesystem::path& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::size_t count = 0;
    for (std::string word; words >> word;) ++count;
    return count;
  }
  return 0;
}

}  // namespace

Result<std::vector<Pose>> sweep_poses_from_file(const std::filesystem::path& file,
                                                std::span<const std::filesystem::path> sweeps) {
  if (numbers_per_line(file) != 8) {
    auto poses = read_kitti_poses(file);
    if (poses && poses->size() < sweeps.size()) return count_mismatch(file, poses->size(), sweeps.size());
    return poses;
  }
  const auto track = read_tum_poses(file);
  if (!track) return track.error();
  if (track->size() != sweeps.size()) return poses_at(*track, file, sweeps);
  std::vector<Pose> poses;
  for (const TimedPose& pose : *track) poses.push_back(pose.T_world_sensor);
  return poses;
}

Result<std::vector<Pose>> sweep_poses_from_imu(const std::filesystem::path& imu,
                                               std::span<const std::filesystem::path> sweeps) {
  const auto samples = std::filesystem::is_directory(imu) ? read_kitti_oxts(imu) : read_imu_csv(imu);
  if (!samples) return samples.error();
  const auto track = integrate_imu(*samples);
  if (!track) return Error{track.error().code, imu.string() + ": " + track.error().message};
  if (track->size() != sweeps.size()) return poses_at(*track, imu, sweeps);
  std::vector<Pose> poses;
  for (const TimedPose& pose : *track) poses.push_back(pose.T_world_sensor);
  return poses;
}

Result<std::vector<double>> sweep_times(std::span<const std::filesystem::path> sweeps) {
  std::vector<double> times;
  if (sweeps.empty()) return times;
  const auto folder = std::filesystem::absolute(sweeps.front()).parent_path();
  for (const auto& candidate : {folder / "times.txt", folder.parent_path() / "times.txt"}) {
    std::ifstream file(candidate);
    if (!file) continue;
    for (double time_s = 0; file >> time_s;) times.push_back(time_s);
    if (times.size() < sweeps.size()) return count_mismatch(candidate, times.size(), sweeps.size());
    times.resize(sweeps.size());
    return times;
  }
  for (std::size_t i = 0; i < sweeps.size(); ++i)
    times.push_back(static_cast<double>(i) * kDefaultSweepInterval_s);
  return times;
}

}  // namespace pointreel
