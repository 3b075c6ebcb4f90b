#include "pcl_icp.h"

#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>

#include <ctime>
#include <random>

namespace pointreel {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointNormal>;

// A voxel's point is the mean of those in it.
PclCloud::Ptr thinned(const PointCloud& sweep, const PclIcpSettings& settings, std::mt19937& random) {
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  const auto leaf_m = static_cast<float>(settings.voxel_m);
  if (settings.seed) {
    for (float& coordinate : corner) coordinate = leaf_m * static_cast<float>(random() % 1024) / 1024;
  }
  PclCloud::Ptr cloud(new PclCloud);
  for (const Point3f& p : sweep.positions) {
    if (settings.seed && random() % 2 == 0) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = Eigen::Vector3f(p.x, p.y, p.z) + corner;
    cloud->push_back(point);
  }
  PclCloud::Ptr result(new PclCloud);
  pcl::VoxelGrid<pcl::PointNormal> filter;
  filter.setLeafSize(leaf_m, leaf_m, leaf_m);
  filter.setInputCloud(cloud);
  filter.filter(*result);
  for (pcl::PointNormal& point : *result) point.getVector3fMap() -= corner;
  return result;
}

void add_normals(const PclCloud::Ptr& cloud) {
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setKSearch(20);
  estimation.setInputCloud(cloud);
  estimation.compute(*cloud);
}

template <class Icp>
bool align(Icp& icp, const PclCloud::Ptr& current, const PclCloud::Ptr& previous,
           const PclIcpSettings& settings, Eigen::Matrix4f& T_previous_current) {
  icp.setInputSource(current);
  icp.setInputTarget(previous);
  icp.setMaxCorrespondenceDistance(settings.farthest_m);
  PclCloud aligned;
  icp.align(aligned, T_previous_current);
  if (!icp.hasConverged()) return false;
  T_previous_current = icp.getFinalTransformation();
  return true;
}

bool align(const PclCloud::Ptr& current, const PclCloud::Ptr& previous, const PclIcpSettings& settings,
           Eigen::Matrix4f& T_previous_current) {
  if (settings.method == PclMethod::generalised) {
    pcl::GeneralizedIterativeClosestPoint<pcl::PointNormal, pcl::PointNormal> icp;  // 20 neighbours
    icp.setMaximumIterations(50);
    return align(icp, current, previous, settings, T_previous_current);
  }
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setMaximumIterations(100);
  icp.setTransformationEpsilon(1e-8);
  return align(icp, current, previous, settings, T_previous_current);
}

}  // namespace

MotionTrack pcl_icp_track(const std::vector<PointCloud>& sweeps, const PclIcpSettings& settings) {
  MotionTrack track;
  std::mt19937 random(settings.seed.value_or(0));
  PclCloud::Ptr previous;
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  for (const PointCloud& sweep : sweeps) {
    const std::clock_t begin = std::clock();
    PclCloud::Ptr current = thinned(sweep, settings, random);
    if (settings.method == PclMethod::point_to_plane) add_normals(current);
    if (previous) {
      if (!align(current, previous, settings, guess)) ++track.failures;
      track.T_previous_sweep.emplace_back(guess.cast<double>());
      track.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    previous = std::move(current);
  }
  return track;
}

}  // namespace pointreel
