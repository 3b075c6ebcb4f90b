#include "common/quality.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "common/nearest_points.h"

namespace pointreel {
namespace {

ErrorSummary nearest_errors(std::span<const Point3f> from, std::span<const Point3f> to) {
  ErrorSummary errors;
  if (to.empty()) return errors;
  const NearestPoints candidates(to);
  for (const Point3f& p : from) errors.add(candidates.nearest(p).distance_m);
  return errors;
}

Eigen::Vector3d vector_of(const Point3f& p) {
  return {p.x, p.y, p.z};
}

}  // namespace

void ErrorSummary::add(double error_m) {
  ++count;
  sum_m += error_m;
  sum_squares_m2 += error_m * error_m;
  max_m = std::max(max_m, error_m);
}

void ErrorSummary::merge(const ErrorSummary& other) {
  count += other.count;
  sum_m += other.sum_m;
  sum_squares_m2 += other.sum_squares_m2;
  max_m = std::max(max_m, other.max_m);
}

double ErrorSummary::rms_m() const {
  return count == 0 ? 0 : std::sqrt(sum_squares_m2 / static_cast<double>(count));
}

void SweepQuality::merge(const SweepQuality& other) {
  points_in += other.points_in;
  points_out += other.points_out;
  non_finite += other.non_finite;
  points_lost += other.points_lost;
  farthest_m = std::max(farthest_m, other.farthest_m);
  paired.merge(other.paired);
  paired_range.merge(other.paired_range);
  paired_angular.merge(other.paired_angular);
  nearest_decoded.merge(other.nearest_decoded);
  nearest_original.merge(other.nearest_original);
}

SweepQuality measure_pairs(const PointCloud& original, const DecodedSweep& decoded,
                           const std::vector<std::int64_t>& pairs) {
  SweepQuality quality;
  quality.points_in = original.size();
  quality.points_out = decoded.cloud.size();
  for (std::size_t i = 0; i < original.size(); ++i) {
    const Point3f& p = original.positions[i];
    if (!is_finite(p)) {
      ++quality.non_finite;
      continue;
    }
    if (pairs[i] < 0) {
      ++quality.points_lost;
      continue;
    }
    const Point3f& q = decoded.cloud.positions[static_cast<std::size_t>(pairs[i])];
    quality.paired.add((vector_of(p) - vector_of(q)).norm());
    const Eigen::Vector3d p_key = decoded.T_key_sensor * vector_of(p),
                          q_key = decoded.T_key_sensor * vector_of(q);
    quality.farthest_m = std::max(quality.farthest_m, p_key.norm());
    quality.paired_range.add(std::fabs(p_key.norm() - q_key.norm()));
    quality.paired_angular.add((p_key - q_key.normalized() * p_key.norm()).norm());
  }
  return quality;
}

SweepQuality measure_quality(const PointCloud& original, const DecodedSweep& decoded,
                             const std::vector<std::int64_t>& pairs) {
  SweepQuality quality = measure_pairs(original, decoded, pairs);
  std::vector<Point3f> finite;
  finite.reserve(original.size());
  std::copy_if(original.positions.begin(), original.positions.end(), std::back_inserter(finite), is_finite);
  quality.nearest_decoded = nearest_errors(finite, decoded.cloud.positions);
  quality.nearest_original = nearest_errors(decoded.cloud.positions, finite);
  return quality;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

}  // namespace pointreel
