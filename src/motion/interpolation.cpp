#include <algorithm>

#include "pointreel/motion.h"

namespace pointreel {

Pose interpolate_pose(std::span<const TimedPose> track, double time_s) {
  if (time_s <= track.front().time_s) return track.front().T_world_sensor;
  const auto after = std::upper_bound(track.begin(), track.end(), time_s,
                                      [](double t, const TimedPose& pose) { return t < pose.time_s; });
  if (after == track.end()) return track.back().T_world_sensor;
  const TimedPose& a = *(after - 1);
  const TimedPose& b = *after;

  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  const Eigen::Quaterniond q_a(a.T_world_sensor.linear());
  const Eigen::Quaterniond q_b(b.T_world_sensor.linear());
  Pose pose = Pose::Identity();
  pose.linear() = q_a.slerp(share, q_b).toRotationMatrix();
  pose.translation() = (1 - share) * a.T_world_sensor.translation() + share * b.T_world_sensor.translation();
  return pose;
}

}  // namespace pointreel
