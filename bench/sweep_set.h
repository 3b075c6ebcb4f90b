// The sweeps of a study, all in memory so that reading files is in no timing, and their poses.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "pointreel/motion.h"
#include "pointreel/point_cloud.h"

namespace pointreel {

// Where the poses come from that the encoder is given.
enum class MotionSource : std::uint8_t { none, imu, poses };
std::string_view to_string(MotionSource source);

struct SweepSet {
  std::vector<PointCloud> sweeps;  // positions only
  std::vector<Pose> poses;         // T_world_sensor of each sweep, empty when not given
  std::vector<Pose> imu_poses;     // the same, integrated from the IMU
  std::size_t points = 0;

  std::vector<MotionSource> motion_sources() const;  // those that can be used, best last
  MotionSource best_motion() const { return motion_sources().back(); }
  // Empty for MotionSource::none.
  const std::vector<Pose>& poses_from(MotionSource source) const;
};

// The first `max_sweeps` of the inputs, 0 for all; `poses` and `imu` may be empty and are matched to all
// inputs. Throws std::runtime_error.
SweepSet load_sweep_set(const std::vector<std::string>& inputs, const std::string& poses,
                        const std::string& imu, std::size_t max_sweeps);

// The middles of `parts` equal parts of `count` sweeps.
std::set<std::size_t> sampled_sweeps(std::size_t count, std::size_t parts);

// A simulated sweep begins ahead, and its pose is of then; poses of real drives are of the middle of a sweep,
// and so is what a whole sweep tells. One pose less.
std::vector<Pose> poses_in_the_middle(const std::vector<Pose>& T_world_begin);

}  // namespace pointreel
