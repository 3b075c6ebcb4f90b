#include "cloud_difference.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pointreel {
namespace {

constexpr std::size_t kNeighbours = 12;

Eigen::Vector3d vector_of(const Point3f& p) {
  return {p.x, p.y, p.z};
}

Point3f normal_at(const NearestPoints& tree, const std::vector<Point3f>& points, const Point3f& place) {
  const auto neighbours = tree.nearest(place, kNeighbours);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : neighbours) mean += vector_of(points[i]);
  mean /= static_cast<double>(neighbours.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : neighbours) {
    const Eigen::Vector3d offset = vector_of(points[i]) - mean;
    scatter += offset * offset.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  return {normal.x(), normal.y(), normal.z()};
}

float along(const Point3f& normal, const Point3f& p, const Point3f& q) {
  return std::fabs(normal.x * (p.x - q.x) + normal.y * (p.y - q.y) + normal.z * (p.z - q.z));
}

double psnr_db(double rms_m, double peak_m) {
  if (rms_m == 0) return std::numeric_limits<double>::infinity();
  return 20 * std::log10(std::sqrt(3.0) * peak_m / rms_m);
}

}  // namespace

ComparedSweep::ComparedSweep(const PointCloud& sweep) : positions_(&sweep.positions), tree_(sweep.positions) {
  normals_.reserve(sweep.size());
  for (const Point3f& p : sweep.positions) normals_.push_back(normal_at(tree_, sweep.positions, p));
}

void Distances::merge(const Distances& other) {
  each_m.insert(each_m.end(), other.each_m.begin(), other.each_m.end());
}

double Distances::mean_m() const {
  return each_m.empty()
             ? 0
             : std::accumulate(each_m.begin(), each_m.end(), 0.0) / static_cast<double>(each_m.size());
}

double Distances::rms_m() const {
  double sum_m2 = 0;
  for (const double distance_m : each_m) sum_m2 += distance_m * distance_m;
  return each_m.empty() ? 0 : std::sqrt(sum_m2 / static_cast<double>(each_m.size()));
}

double Distances::max_m() const {
  return each_m.empty() ? 0 : *std::max_element(each_m.begin(), each_m.end());
}

double Distances::p95_m() const {
  if (each_m.empty()) return 0;
  std::vector<float> sorted = each_m;
  const auto nth =
      sorted.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), nth, sorted.end());
  return *nth;
}

void CloudDifference::merge(const CloudDifference& other) {
  own.merge(other.own);
  to_decoded.merge(other.to_decoded);
  to_original.merge(other.to_original);
  to_decoded_plane.merge(other.to_decoded_plane);
  to_original_plane.merge(other.to_original_plane);
}

double CloudDifference::largest_nearest_m() const {
  return std::max(to_decoded.max_m(), to_original.max_m());
}

double CloudDifference::worse_rms_m() const {
  return std::max(to_decoded.rms_m(), to_original.rms_m());
}

double CloudDifference::d1_psnr_db(double peak_m) const {
  return psnr_db(worse_rms_m(), peak_m);
}

double CloudDifference::d2_psnr_db(double peak_m) const {
  return psnr_db(std::max(to_decoded_plane.rms_m(), to_original_plane.rms_m()), peak_m);
}

Distances own_distances(const std::vector<Point3f>& original, const std::vector<Point3f>& decoded) {
  Distances distances;
  distances.each_m.reserve(original.size());
  for (std::size_t i = 0; i < original.size(); ++i)
    distances.each_m.push_back(static_cast<float>((vector_of(original[i]) - vector_of(decoded[i])).norm()));
  return distances;
}

CloudDifference nearest_differences(const ComparedSweep& original, const std::vector<Point3f>& decoded) {
  CloudDifference difference;
  const NearestPoints tree(decoded);
  const std::vector<Point3f>& positions = original.positions();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto nearest = tree.nearest(positions[i]);
    difference.to_decoded.each_m.push_back(static_cast<float>(nearest.distance_m));
    difference.to_decoded_plane.each_m.push_back(
        along(original.normal(i), positions[i], decoded[nearest.index]));
  }
  for (const Point3f& q : decoded) {
    const auto nearest = original.tree().nearest(q);
    difference.to_original.each_m.push_back(static_cast<float>(nearest.distance_m));
    difference.to_original_plane.each_m.push_back(
        along(original.normal(nearest.index), q, positions[nearest.index]));
  }
  return difference;
}

}  // namespace pointreel
