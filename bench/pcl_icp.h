// PCL's point-to-plane ICP on whole clouds, to compare with. Built where PCL is installed (libpcl-dev).
#pragma once

#include <vector>

#include "drift.h"
#include "pointreel/point_cloud.h"

namespace pointreel {

struct PclIcpSettings {
  double voxel_m = 0.3;   // both clouds are thinned to a point per voxel
  double farthest_m = 1;  // between points that correspond
};

// Each cloud against the one before; the last motion is the guess for the next.
MotionTrack pcl_icp_track(const std::vector<PointCloud>& sweeps, const PclIcpSettings& settings);

}  // namespace pointreel
