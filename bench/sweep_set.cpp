#include "sweep_set.h"

#include <algorithm>

#include "common/motion_input.h"
#include "pointreel/io.h"
#include "require.h"

namespace pointreel {

std::string_view to_string(MotionSource source) {
  switch (source) {
    case MotionSource::none:
      return "none";
    case MotionSource::imu:
      return "imu";
    case MotionSource::poses:
      return "poses";
  }
  return "";
}

std::vector<MotionSource> SweepSet::motion_sources() const {
  std::vector<MotionSource> sources = {MotionSource::none};
  if (!imu_poses.empty()) sources.push_back(MotionSource::imu);
  if (!poses.empty()) sources.push_back(MotionSource::poses);
  return sources;
}

const std::vector<Pose>& SweepSet::poses_from(MotionSource source) const {
  static const std::vector<Pose> unknown;
  return source == MotionSource::poses ? poses : source == MotionSource::imu ? imu_poses : unknown;
}

SweepSet load_sweep_set(const std::vector<std::string>& inputs, const std::string& poses,
                        const std::string& imu, std::size_t max_sweeps) {
  const auto paths = require(expand_inputs(inputs));
  SweepSet set;
  if (!poses.empty()) set.poses = require(sweep_poses_from_file(poses, paths));
  if (!imu.empty()) set.imu_poses = require(sweep_poses_from_imu(imu, paths));
  const std::size_t count = max_sweeps == 0 ? paths.size() : std::min(max_sweeps, paths.size());
  for (std::size_t i = 0; i < count; ++i) {
    PointCloud cloud = require(read_cloud(paths[i]));
    cloud.fields.clear();
    set.points += cloud.size();
    set.sweeps.push_back(std::move(cloud));
  }
  return set;
}

std::set<std::size_t> sampled_sweeps(std::size_t count, std::size_t parts) {
  std::set<std::size_t> sample;
  for (std::size_t k = 0; k < parts; ++k) sample.insert((2 * k + 1) * count / (2 * parts));
  return sample;
}

std::vector<Pose> poses_in_the_middle(const std::vector<Pose>& T_world_begin) {
  std::vector<Pose> T_world_middle;
  for (std::size_t i = 0; i + 1 < T_world_begin.size(); ++i) {
    const TimedPose ends[] = {{0, T_world_begin[i]}, {1, T_world_begin[i + 1]}};
    T_world_middle.push_back(interpolate_pose(ends, 0.5));
  }
  return T_world_middle;
}

}  // namespace pointreel
