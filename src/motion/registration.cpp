#include "motion/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "motion/surface_patches.h"

namespace pointreel {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kInlierM = 0.1;
constexpr double kLeastInlierShare = 0.5;
constexpr int kLeastInliers = 100;
constexpr float kFarthestM = 1000;
constexpr double kLeverArmM = 10;  // makes angles comparable with lengths
// Of the weights' sum. Where the patches leave a direction open, the pose stays as it is.
constexpr double kDamping = 1e-3;
constexpr double kStillM = 1e-3;  // a step that moves nothing by more ends the rounds

// What the patches say about a pose: the normal equations of a step T <- exp(v, w) T.
struct Evidence {
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double weight = 0;
  int inliers = 0;
  double inlier_squares_m2 = 0;
};

// The reference's return nearest to a point among those in its direction; none: infinite distance.
struct Match {
  Eigen::Vector3f difference_m = Eigen::Vector3f::Zero();
  bool found = false;
};

Match match(const GridRays& reference, const Eigen::Vector3f& p_m) {
  const GridRays::Cell cell = reference.cell_towards(p_m);
  Match best;
  if (cell.row < 0) return best;
  float best_m2 = 0;
  for (int dc = -1; dc <= 1; ++dc) {
    const int column = reference.wrapped(cell.column + dc);
    const float range_m = reference.range_m(cell.row, column);
    if (!(range_m > 0 && range_m < kFarthestM)) continue;
    const Eigen::Vector3f difference_m = p_m - reference.point_m(cell.row, column);
    const float m2 = difference_m.squaredNorm();
    if (best.found && m2 >= best_m2) continue;
    best = {difference_m, true};
    best_m2 = m2;
  }
  return best;
}

// Geman and McClure's kernel: a distance of `kernel_m` counts a quarter, what moves by itself nothing.
Evidence evidence_for(const Pose& T_ref_cur, const GridRays& reference, std::span<const SurfacePatch> patches,
                      double kernel_m) {
  const Eigen::Matrix3f rotation = T_ref_cur.linear().cast<float>();
  const Eigen::Vector3f translation_m = T_ref_cur.translation().cast<float>();
  const auto kernel_m2 = static_cast<float>(kernel_m * kernel_m);
  Evidence evidence;
  for (const SurfacePatch& patch : patches) {
    const Eigen::Vector3f p_m = rotation * patch.center_m + translation_m;
    const Match found = match(reference, p_m);
    if (!found.found) continue;
    const Eigen::Vector3f normal = rotation * patch.normal;
    const float distance_m = normal.dot(found.difference_m);
    if (std::fabs(distance_m) < static_cast<float>(kInlierM)) {
      ++evidence.inliers;
      evidence.inlier_squares_m2 += static_cast<double>(distance_m * distance_m);
    }
    const float share = kernel_m2 / (kernel_m2 + distance_m * distance_m);
    const double weight = static_cast<double>(share * share);
    Vector6 jacobian;
    jacobian << normal.cast<double>(), p_m.cross(normal).cast<double>();
    evidence.hessian.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
    evidence.gradient += weight * static_cast<double>(distance_m) * jacobian;
    evidence.weight += weight;
  }
  evidence.hessian = evidence.hessian.selfadjointView<Eigen::Lower>();
  return evidence;
}

Vector6 scale() {
  Vector6 scale;
  scale << 1, 1, 1, 1 / kLeverArmM, 1 / kLeverArmM, 1 / kLeverArmM;
  return scale;
}

// By how much it moves a point a lever arm away.
double step_m(const Vector6& step) {
  return step.head<3>().norm() + kLeverArmM * step.tail<3>().norm();
}

Vector6 solve(const Evidence& evidence) {
  Matrix6 damped = evidence.hessian;
  const Vector6 damping = (kDamping * evidence.weight + 1e-9) * scale().cwiseInverse().cwiseAbs2();
  damped.diagonal() += damping;
  const Vector6 step = damped.ldlt().solve(-evidence.gradient);
  return step.allFinite() ? step : Vector6::Zero();
}

Pose moved(const Vector6& step, const Pose& pose) {
  const double angle_rad = step.tail<3>().norm();
  Pose change = Pose::Identity();
  if (angle_rad > 0) {
    change.linear() = Eigen::AngleAxisd(angle_rad, step.tail<3>() / angle_rad).toRotationMatrix();
  }
  change.translation() = step.head<3>();
  return change * pose;
}

double weakest_share(const Evidence& evidence) {
  if (!(evidence.weight > 0)) return 0;
  const Matrix6 scaled = scale().asDiagonal() * evidence.hessian * scale().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled, Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues().minCoeff() / evidence.weight);
}

// From one start: wide kernels first when it may be far off.
Registration register_from(const Pose& start, std::span<const double> kernels_m, const GridRays& reference,
                           std::span<const SurfacePatch> patches, const RegistrationSettings& settings) {
  constexpr double kFinestM = 0.1;
  const auto coarse =
      patches.first(std::min(patches.size(), static_cast<std::size_t>(std::max(0, settings.coarse_patches))));
  Pose pose = start;
  for (const double kernel_m : kernels_m) {
    for (int i = 0; i < 2; ++i) pose = moved(solve(evidence_for(pose, reference, coarse, kernel_m)), pose);
  }
  Evidence evidence = evidence_for(pose, reference, patches, kFinestM);
  bool settled = false;
  for (int i = 0; i < settings.rounds && !settled; ++i) {
    const Vector6 step = solve(evidence);
    pose = moved(step, pose);
    evidence = evidence_for(pose, reference, patches, kFinestM);
    settled = step_m(step) < kStillM;
  }

  Registration result;
  result.T_ref_cur = start;
  if (patches.empty()) return result;
  result.inlier_share = static_cast<double>(evidence.inliers) / static_cast<double>(patches.size());
  result.rms_m = std::sqrt(evidence.inlier_squares_m2 / std::max(1, evidence.inliers));
  result.weakest_share = weakest_share(evidence);
  result.converged = evidence.inliers >= kLeastInliers && result.inlier_share >= kLeastInlierShare &&
                     pose.matrix().allFinite();
  if (result.converged) result.T_ref_cur = pose;
  return result;
}

}  // namespace

Registration register_sweeps(const RangeGrid& reference, const RangeGrid& current,
                             const std::optional<Pose>& guess, const RegistrationSettings& settings) {
  constexpr std::array<double, 4> kWideM = {2, 1, 0.5, 0.25};
  const GridRays reference_rays(reference);
  const auto patches = find_surface_patches(GridRays(current), settings.patches);
  Registration result;
  if (guess && guess->matrix().allFinite()) {
    result = register_from(*guess, std::span(kWideM).last(2), reference_rays, patches, settings);
    if (result.converged) return result;
  }
  const Registration wide = register_from(Pose::Identity(), kWideM, reference_rays, patches, settings);
  if (wide.converged || !guess || !guess->matrix().allFinite()) return wide;
  return result;
}

}  // namespace pointreel
