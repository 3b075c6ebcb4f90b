// align_patches: the pose at which patches of one sweep's surfaces fit a reference, whatever that is made of.
//
// A reference has `void measure(PatchBlock&) const`, which fills in how far its surfaces are from the planes
// of patches, and `motion_per_turn` (SweepMotion::per_turn).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "motion/patch_block.h"
#include "motion/patch_evidence.h"
#include "motion/registration.h"
#include "motion/surface_patches.h"

namespace pointreel {

struct AlignmentSettings {
  int coarse_patches;  // of the rounds that find the way
  int rounds;          // at most, of the last ones, which take all patches
};

namespace patch_alignment {

inline constexpr float kInlierM = 0.1F;
inline constexpr float kFinestM = 0.1F;  // kernel of the last rounds
inline constexpr double kLeastInlierShare = 0.5;
inline constexpr int kLeastInliers = 100;
inline constexpr double kStillM = 1e-3;  // a step that moves nothing by more ends the rounds

// By how many turns farther around a point is seen in this sweep than in the reference, as the sine goes.
inline float turns_between(const Eigen::Vector3f& in_reference_m, const Eigen::Vector3f& here_m) {
  constexpr auto kTurnsPerRad = static_cast<float>(1 / kTurn);
  const float lengths_m2 = std::sqrt(in_reference_m.head<2>().squaredNorm() * here_m.head<2>().squaredNorm());
  const float sine_m2 = in_reference_m.x() * here_m.y() - in_reference_m.y() * here_m.x();
  return kTurnsPerRad * sine_m2 / std::max(lengths_m2, 1e-6F);
}

// A patch in the reference's coordinates that has a partner there.
struct Match {
  Eigen::Vector3f center_m, normal;
  float distance_m;  // of the reference from its plane
  float turns;       // turns_between() its center in the reference and here
};

// Calls use(match) for each.
template <class Reference, class Use>
void for_each_match(const Pose& T_ref_cur, const Reference& reference, std::span<const SurfacePatch> patches,
                    const Use& use) {
  const Eigen::Matrix3f rotation = T_ref_cur.linear().cast<float>();
  const Eigen::Vector3f translation_m = T_ref_cur.translation().cast<float>();
  PatchBlock block;
  std::array<float, PatchBlock::kMost> turns;
  for (std::size_t first = 0; first < patches.size(); first += block.count) {
    block.count = std::min(PatchBlock::kMost, patches.size() - first);
    for (std::size_t i = 0; i < block.count; ++i) {
      const SurfacePatch& patch = patches[first + i];
      const Eigen::Vector3f turned_m = rotation * patch.center_m;
      turns[i] = turns_between(turned_m + translation_m, patch.center_m);
      block.set(i, turned_m + (1 + reference.motion_per_turn * turns[i]) * translation_m,
                rotation * patch.normal);
    }
    for (std::size_t i = block.count; i % PatchBlock::kLanes != 0; ++i)
      block.set(i, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero());
    reference.measure(block);
    for (std::size_t i = 0; i < block.count; ++i) {
      if (block.distance_m[i] < PatchBlock::kNoPartner)
        use(Match{block.center_m(i), block.normal(i), block.distance_m[i], turns[i]});
    }
  }
}

// Geman and McClure's kernel: a distance of `kernel_m` counts a quarter, what moves by itself nothing.
inline float robust_share(float distance_m, float kernel_m) {
  return kernel_m * kernel_m / (kernel_m * kernel_m + distance_m * distance_m);
}

// Sums in float: a step need not be right to more than a few digits.
template <class Reference>
Evidence evidence_for(const Pose& T_ref_cur, const Reference& reference,
                      std::span<const SurfacePatch> patches, float kernel_m) {
  Evidence evidence;
  float hessian[6][6] = {}, gradient[6] = {};
  for_each_match(T_ref_cur, reference, patches, [&](const Match& match) {
    const float distance_m = match.distance_m;
    if (std::fabs(distance_m) < kInlierM) {
      ++evidence.inliers;
      evidence.inlier_squares_m2 += static_cast<double>(distance_m * distance_m);
    }
    const float share = robust_share(distance_m, kernel_m);
    const float weight = share * share;
    const Eigen::Vector3f& normal = match.normal;
    const Eigen::Vector3f turning = match.center_m.cross(normal);
    const float jacobian[6] = {normal.x(), normal.y(), normal.z(), turning.x(), turning.y(), turning.z()};
    for (int i = 0; i < 6; ++i) {
      const float weighted = weight * jacobian[i];
      gradient[i] += distance_m * weighted;
      for (int j = i; j < 6; ++j) hessian[i][j] += weighted * jacobian[j];
    }
    evidence.weight += static_cast<double>(weight);
  });
  const Eigen::Matrix<float, 6, 6> half =
      Eigen::Matrix<float, 6, 6>::Map(&hessian[0][0]);  // column by column
  evidence.hessian = half.selfadjointView<Eigen::Lower>().toDenseMatrix().cast<double>();
  evidence.gradient = Eigen::Matrix<float, 6, 1>::Map(gradient).cast<double>();
  return evidence;
}

// Mean cost of those that match anything: the farther away, the fewer do, which says nothing. Infinite when
// fewer than `least` do.
template <class Reference>
double mean_cost_m2(const Pose& T_ref_cur, const Reference& reference, std::span<const SurfacePatch> patches,
                    float kernel_m, int least) {
  int matches = 0;
  float sum_m2 = 0;
  for_each_match(T_ref_cur, reference, patches, [&](const Match& match) {
    ++matches;
    sum_m2 += match.distance_m * match.distance_m * robust_share(match.distance_m, kernel_m);
  });
  if (matches == 0 || matches < least) return std::numeric_limits<double>::infinity();
  return static_cast<double>(sum_m2) / matches;
}

// Steps find the nearest minimum only, and along a street there are many: looks for the best one along the
// direction that is seen least.
template <class Reference>
Pose best_along_weakest(const Pose& pose, const Evidence& coarse_evidence, const Reference& reference,
                        std::span<const SurfacePatch> patches) {
  constexpr float kKernelM = 0.3F;
  constexpr int kSteps = 10;  // to each side
  constexpr double kStepM = 0.3;
  constexpr float kAcross = 0.3F;
  constexpr std::size_t kMostPatches = 400;
  const Eigen::Vector3d direction = weakest_translation(coarse_evidence);
  if (!direction.allFinite()) return pose;
  // Surfaces along the direction say nothing.
  const Eigen::Vector3f seen_from_patch = (pose.linear().transpose() * direction).cast<float>();
  std::vector<SurfacePatch> across;
  for (const SurfacePatch& patch : patches) {
    if (across.size() < kMostPatches && std::fabs(patch.normal.dot(seen_from_patch)) > kAcross) {
      across.push_back(patch);
    }
  }
  const int least = static_cast<int>(across.size() / 2);
  double least_m2 = mean_cost_m2(pose, reference, across, kKernelM, least);
  Pose best = pose;
  for (int step = -kSteps; step <= kSteps; ++step) {
    if (step == 0) continue;
    Pose candidate = pose;
    candidate.translation() += step * kStepM * direction;
    const double cost_m2 = mean_cost_m2(candidate, reference, across, kKernelM, least);
    if (!(cost_m2 < least_m2)) continue;
    least_m2 = cost_m2;
    best = candidate;
  }
  return best;
}

// A start may be the guess, and near, or none, and then the widest kernels come first.
enum class Start : std::uint8_t { near, far };

template <class Reference>
Registration register_from(const Pose& start_pose, Start start, const Reference& reference,
                           std::span<const SurfacePatch> patches, const AlignmentSettings& settings) {
  const auto coarse =
      patches.first(std::min(patches.size(), static_cast<std::size_t>(settings.coarse_patches)));
  Pose pose = start_pose;
  const auto step_twice = [&](float kernel_m) {
    for (int i = 0; i < 2; ++i) pose = moved(solve(evidence_for(pose, reference, coarse, kernel_m)), pose);
  };
  if (start == Start::far) {
    for (const float kernel_m : {2.0F, 1.0F}) step_twice(kernel_m);
  }
  pose = best_along_weakest(pose, evidence_for(pose, reference, coarse, 0.5F), reference, patches);
  for (const float kernel_m : {0.5F, 0.25F}) step_twice(kernel_m);
  Evidence evidence = evidence_for(pose, reference, patches, kFinestM);
  bool settled = false;
  for (int i = 0; i < settings.rounds && !settled; ++i) {
    const Vector6 step = solve(evidence);
    pose = moved(step, pose);
    evidence = evidence_for(pose, reference, patches, kFinestM);
    settled = step_m(step) < kStillM;
  }

  Registration result;
  result.T_ref_cur = start_pose;
  if (patches.empty()) return result;
  result.inlier_share = static_cast<double>(evidence.inliers) / static_cast<double>(patches.size());
  result.rms_m = std::sqrt(evidence.inlier_squares_m2 / std::max(1, evidence.inliers));
  result.weakest_share = weakest_share(evidence);
  result.converged = evidence.inliers >= kLeastInliers && result.inlier_share >= kLeastInlierShare &&
                     pose.matrix().allFinite();
  if (result.converged) result.T_ref_cur = pose;
  return result;
}

}  // namespace patch_alignment

// `patches`: any first part must be spread as the whole. Any guess gives a finite pose.
template <class Reference>
Registration align_patches(const Reference& reference, std::span<const SurfacePatch> patches,
                           const std::optional<Pose>& guess, const AlignmentSettings& settings) {
  using patch_alignment::register_from, patch_alignment::Start;
  if (!guess || !guess->matrix().allFinite()) {
    return register_from(Pose::Identity(), Start::far, reference, patches, settings);
  }
  Registration near = register_from(*guess, Start::near, reference, patches, settings);
  if (near.converged) return near;
  Registration far = register_from(Pose::Identity(), Start::far, reference, patches, settings);
  return far.converged ? far : near;
}

}  // namespace pointreel
