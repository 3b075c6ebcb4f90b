#include "motion/registration.h"

#include <Eigen/Cholesky>
#include <cmath>
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

// How much more of the motion should fall into a turn, the pose being free to follow (Schur's complement).
TurnEvidence evidence_of_turning(const Pose& T_ref_cur, const GridReference& reference,
                                 std::span<const SurfacePatch> patches) {
  using namespace patch_alignment;
  using Vector7f = Eigen::Matrix<float, 7, 1>;
  const Eigen::Vector3f translation_m = T_ref_cur.translation().cast<float>();
  Eigen::Matrix<double, 7, 7> hessian = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> gradient = Eigen::Matrix<double, 7, 1>::Zero();
  double weights = 0;
  for_each_match(T_ref_cur, reference, patches, [&](const Match& match) {
    Vector7f jacobian;
    jacobian << match.normal, match.center_m.cross(match.normal),
        match.turns * match.normal.dot(translation_m);
    const float share = robust_share(match.distance_m, kFinestM);
    const Vector7f weighted = share * share * jacobian;
    hessian += (weighted * jacobian.transpose()).cast<double>();
    gradient += (match.distance_m * weighted).cast<double>();
    weights += static_cast<double>(share * share);
  });
  Evidence of_pose;
  of_pose.hessian = hessian.topLeftCorner<6, 6>();
  of_pose.weight = weights;
  const Vector6 with_pose = hessian.topRightCorner<6, 1>();
  const Vector6 pose_follows = damped_hessian(of_pose).ldlt().solve(with_pose);
  const double weight_m2 = hessian(6, 6) - with_pose.dot(pose_follows);
  const double more = -(gradient(6) - gradient.head<6>().dot(pose_follows)) / weight_m2;
  if (!(weight_m2 > 0) || !std::isfinite(weight_m2) || !std::isfinite(more)) return {};
  return {more, weight_m2};
}

}  // namespace

Registration register_sweeps(const GridRays& reference, const GridRays& current,
                             const std::optional<Pose>& guess, double motion_per_turn) {
  constexpr int kPatches = 1000;  // twice as many find the same motion
  constexpr AlignmentSettings kSettings{.coarse_patches = 400, .rounds = 3};
  const GridReference turning{reference, static_cast<float>(motion_per_turn)};
  const auto patches = find_surface_patches(current, kPatches);
  Registration found = align_patches(turning, patches, guess, kSettings);
  if (found.converged) found.turning = evidence_of_turning(found.T_ref_cur, turning, patches);
  return found;
}

}  // namespace pointreel
