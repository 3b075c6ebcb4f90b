#include "motion/rotation.h"

#include <Eigen/SVD>

namespace pointreel {
namespace {

// Files with three decimals deviate by 0.0005; a millimetre at 100 m is 0.00001 rad, so more is no
// calibration.
constexpr double kMaxElementDeviation = 2e-3;

}  // namespace

std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  const double deviation = (rotation - m).cwiseAbs().maxCoeff();
  // A mirror is orthonormal as well, hence the determinant; the negated test also catches overflow to NaN.
  if (!(deviation <= kMaxElementDeviation) || rotation.determinant() < 0) return std::nullopt;
  return rotation;
}

std::optional<Pose> pose_from_matrix(const Matrix34& matrix) {
  const std::optional<Eigen::Matrix3d> rotation = nearest_rotation(matrix.leftCols<3>());
  if (!rotation) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = *rotation;
  pose.translation() = matrix.col(3);
  return pose;
}

}  // namespace pointreel
