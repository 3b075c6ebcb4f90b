// Rotations out of rounded or wrong 3x4 matrices.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "pointreel/motion.h"

namespace pointreel {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

// The rotation nearest to `m`, or nothing where an element of it is further than rounding explains.
std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& m);

// [R t] as a pose, with R made orthonormal; nothing where R is no rotation.
std::optional<Pose> pose_from_matrix(const Matrix34& matrix);

}  // namespace pointreel
