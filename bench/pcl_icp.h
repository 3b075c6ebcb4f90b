// PCL's ICP on whole clouds, to compare with. Built where PCL is installed (libpcl-dev).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drift.h"
#include "pointreel/point_cloud.h"

namespace pointreel {

enum class PclMethod : std::uint8_t { point_to_plane, generalised };

struct PclIcpSettings {
  double voxel_m = 0.3;   // both clouds are thinned to a point per voxel
  double farthest_m = 1;  // between points that correspond
  PclMethod method = PclMethod::point_to_plane;
  // Takes a random half of the points, and voxels from a random corner; none: all, and from the origin.
  std::optional<std::uint32_t> seed = std::nullopt;
};

// Each cloud against the one before; the last motion is the guess for the next.
MotionTrack pcl_icp_track(const std::vector<PointCloud>& sweeps, const PclIcpSettings& settings);

}  // namespace pointreel
