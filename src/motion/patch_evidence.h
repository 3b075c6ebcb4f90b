// What the distances of patches from their partners say about a pose, and the steps that follow from it.
#pragma once

#include <Eigen/Geometry>

#include "pointreel/motion.h"

namespace pointreel::patch_alignment {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// How badly a pose fits, and the normal equations of a step T <- exp(v, w) T.
struct Evidence {
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double weight = 0;
  int inliers = 0;
  double inlier_squares_m2 = 0;
};

// With a little of the weights' sum added, so that a direction that the patches leave open can be solved for.
Matrix6 damped_hessian(const Evidence& evidence);

// A damped step of Gauss and Newton: where the patches leave a direction open, the pose stays as it is.
Vector6 solve(const Evidence& evidence);

Pose moved(const Vector6& step, const Pose& pose);

// By how much it moves a point a lever arm away.
double step_m(const Vector6& step);

// Registration::weakest_share
double weakest_share(const Evidence& evidence);

// The translation that the patches see least, rotations free.
Eigen::Vector3d weakest_translation(const Evidence& evidence);

}  // namespace pointreel::patch_alignment
