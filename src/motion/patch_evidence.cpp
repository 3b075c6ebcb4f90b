#include "motion/patch_evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

namespace pointreel::patch_alignment {
namespace {

constexpr double kLeverArmM = 10;  // makes angles comparable with lengths
constexpr double kDamping = 1e-3;  // of the weights' sum

Vector6 scale() {
  Vector6 scale;
  scale << 1, 1, 1, 1 / kLeverArmM, 1 / kLeverArmM, 1 / kLeverArmM;
  return scale;
}

}  // namespace

double step_m(const Vector6& step) {
  return step.head<3>().norm() + kLeverArmM * step.tail<3>().norm();
}

Matrix6 damped_hessian(const Evidence& evidence) {
  Matrix6 damped = evidence.hessian;
  const Vector6 damping = (kDamping * evidence.weight + 1e-9) * scale().cwiseInverse().cwiseAbs2();
  damped.diagonal() += damping;
  return damped;
}

Vector6 solve(const Evidence& evidence) {
  const Vector6 step = damped_hessian(evidence).ldlt().solve(-evidence.gradient);
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

Eigen::Vector3d weakest_translation(const Evidence& evidence) {
  const Matrix6& h = evidence.hessian;
  const Eigen::Matrix3d rotations = h.bottomRightCorner<3, 3>() + 1e-9 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d translations =
      h.topLeftCorner<3, 3>() - h.topRightCorner<3, 3>() * rotations.ldlt().solve(h.bottomLeftCorner<3, 3>());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(translations);
  return solver.eigenvectors().col(0);
}

}  // namespace pointreel::patch_alignment
