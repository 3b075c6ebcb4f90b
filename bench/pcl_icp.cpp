#include "pcl_icp.h"

#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include <ctime>

namespace pointreel {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointNormal>;

PclCloud::Ptr with_normals(const PointCloud& sweep, double voxel_m) {
  PclCloud::Ptr cloud(new PclCloud);
  for (const Point3f& p : sweep.positions) {
    pcl::PointNormal point;
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    cloud->push_back(point);
  }
  PclCloud::Ptr thinned(new PclCloud);
  pcl::VoxelGrid<pcl::PointNormal> filter;
  const auto leaf_m = static_cast<float>(voxel_m);
  filter.setLeafSize(leaf_m, leaf_m, leaf_m);
  filter.setInputCloud(cloud);
  filter.filter(*thinned);
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setKSearch(20);
  estimation.setInputCloud(thinned);
  estimation.compute(*thinned);
  return thinned;
}

}  // namespace

MotionTrack pcl_icp_track(const std::vector<PointCloud>& sweeps, const PclIcpSettings& settings) {
  MotionTrack track;
  PclCloud::Ptr previous;
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  for (const PointCloud& sweep : sweeps) {
    const std::clock_t begin = std::clock();
    PclCloud::Ptr current = with_normals(sweep, settings.voxel_m);
    if (previous) {
      pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
      icp.setInputSource(current);
      icp.setInputTarget(previous);
      icp.setMaxCorrespondenceDistance(settings.farthest_m);
      icp.setMaximumIterations(100);
      icp.setTransformationEpsilon(1e-8);
      PclCloud aligned;
      icp.align(aligned, guess);
      if (icp.hasConverged())
        guess = icp.getFinalTransformation();
      else
        ++track.failures;
      track.T_previous_sweep.emplace_back(guess.cast<double>());
      track.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    previous = std::move(current);
  }
  return track;
}

}  // namespace pointreel
