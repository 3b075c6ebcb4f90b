#include "motion/registration.h"

#include <Eigen/Cholesky>
#include <span>

#include "motion/grid_matching.h"
#include "motion/patch_alignment.h"
#include "motion/surface_patches.h"

namespace pointreel {
namespace {

// The returns of a sweep.
struct GridReference {
  const GridRays& rays;
  float motion_per_turn;
  void measure(PatchBlock& block) const { measure_patches(rays, block); }
};

// A step of the motion per turn beside one of the pose (Schur's complement).
TurnEvidence evidence_of_turning(const Pose& T_ref_cur, const GridReference& reference,
                                 std::span<const SurfacePatch> patches) {
  using namespace patch_alignment;
  const Evidence of_pose = evidence_for(T_ref_cur, reference, patches, kFinestM);
  const Eigen::Matrix3f rotation = T_ref_cur.linear().cast<float>();
  const Eigen::Vector3f translation_m = T_ref_cur.translation().cast<float>();
  Vector6 with_pose = Vector6::Zero();
  double square = 0, gradient = 0;
  for_each_match(T_ref_cur, reference, patches,
                 [&](const SurfacePatch& patch, const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal,
                     float distance_m) {
                   const float share = robust_share(distance_m, kFinestM);
                   const float turns =
                       turns_between(rotation * patch.center_m + translation_m, patch.center_m);
                   const float by_turning_m = turns * normal.dot(translation_m);
                   const float weighted_m = share * share * by_turning_m;
                   with_pose.head<3>() += (weighted_m * normal).cast<double>();
                   with_pose.tail<3>() += (weighted_m * p_m.cross(normal)).cast<double>();
                   square += static_cast<double>(weighted_m * by_turning_m);
                   gradient += static_cast<double>(weighted_m * distance_m);
                 });
  const Vector6 pose_for_it = damped_hessian(of_pose).ldlt().solve(with_pose);
  const double weight = square - with_pose.dot(pose_for_it);
  const double more = -(gradient - of_pose.gradient.dot(pose_for_it)) / weight;
  if (!(weight > 0) || !std::isfinite(more)) return {};
  return {more, weight};
}

}  // namespace

Registration register_sweeps(const GridRays& reference, const GridRays& current,
                             const std::optional<Pose>& guess, const RegistrationSettings& settings,
                             double motion_per_turn) {
  const GridReference turning{reference, static_cast<float>(motion_per_turn)};
  const auto patches = find_surface_patches(current, settings.patches);
  Registration found = align_patches(turning, patches, guess, settings);
  if (found.converged) found.turning = evidence_of_turning(found.T_ref_cur, turning, patches);
  return found;
}

}  // namespace pointreel
