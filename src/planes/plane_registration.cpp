// register_planes: tiles of the later sweep's planes against the planes of the earlier one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>

#include "motion/patch_alignment.h"
#include "planes/planes_by_direction.h"
#include "pointreel/planes.h"

namespace pointreel {
namespace {

// Each of the four directions of walls in two, as few tiles lie across the way, and each is wanted.
constexpr std::size_t kTileFacings = 2 * kFacings;
std::size_t facing_of_tile(const Eigen::Vector3f& normal) {
  constexpr float kTangent = 0.41421356F;  // of an eighth of a half turn
  const float along_x = std::fabs(normal.x()), along_y = std::fabs(normal.y());
  const int facing_of_patch = facing(normal);
  const bool oblique =
      facing_of_patch > 0 && std::min(along_x, along_y) > kTangent * std::max(along_x, along_y);
  return static_cast<std::size_t>(2 * facing_of_patch + (oblique ? 1 : 0));
}

// Tiles spread over all directions they face.
std::vector<SurfacePatch> patches_of(const SweepPlanes& sweep, int most) {
  std::vector<SurfacePatch> patches;
  const std::size_t count = sweep.tiles.size();
  if (count == 0) return patches;
  auto step = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
  while (std::gcd(step, count) != 1) ++step;
  std::array<int, kTileFacings> count_facing{};
  for (std::size_t i = 0, tile = 0; i < count && static_cast<int>(patches.size()) < most; ++i) {
    tile = (tile + step) % count;
    const Eigen::Vector3f normal = sweep.planes[sweep.tiles[tile].plane].normal.cast<float>();
    int& facing_alike = count_facing[facing_of_tile(normal)];
    if (facing_alike >= most / 5) continue;
    ++facing_alike;
    patches.push_back({sweep.tiles[tile].center_m, normal});
  }
  return patches;
}

// How many tiles that face the direction which is seen least say that the pose is right, and how many would
// say so of one farther along it.
struct Support {
  int here = 0, elsewhere = 0;
  Eigen::Vector3d to_elsewhere_m = Eigen::Vector3d::Zero();
};

Support support_of(const Pose& pose, const PlanesByDirection& planes, std::span<const SurfacePatch> patches) {
  using namespace patch_alignment;
  constexpr float kFacing = 0.3F;
  constexpr std::size_t kMostPatches = 200;
  constexpr double kStepM = 0.15;
  constexpr int kSteps = 20, kStillHere = 2;  // to each side
  const Eigen::Vector3d direction = weakest_translation(evidence_for(pose, planes, patches, kInlierM));
  const Eigen::Vector3f seen_from_patch = (pose.linear().transpose() * direction).cast<float>();
  std::vector<SurfacePatch> across;
  for (const SurfacePatch& patch : patches) {
    if (across.size() < kMostPatches && std::fabs(patch.normal.dot(seen_from_patch)) > kFacing)
      across.push_back(patch);
  }
  Support support;
  for (int step = -kSteps; step <= kSteps; ++step) {
    Pose moved_pose = pose;
    moved_pose.translation() += step * kStepM * direction;
    int inliers = 0;
    for_each_match(moved_pose, planes, std::span<const SurfacePatch>(across),
                   [&](const Match& match) { inliers += std::fabs(match.distance_m) < kInlierM ? 1 : 0; });
    if (step == 0) support.here = inliers;
    if (std::abs(step) <= kStillHere || inliers <= support.elsewhere) continue;
    support.elsewhere = inliers;
    support.to_elsewhere_m = step * kStepM * direction;
  }
  return support;
}

// To the nearest minimum.
void refine(const PlanesByDirection& planes, std::span<const SurfacePatch> patches, Registration& found) {
  using namespace patch_alignment;
  for (const float kernel_m : {0.25F, 0.25F, 0.1F, 0.1F, 0.1F})
    found.T_ref_cur = moved(solve(evidence_for(found.T_ref_cur, planes, patches, kernel_m)), found.T_ref_cur);
  const Evidence evidence = evidence_for(found.T_ref_cur, planes, patches, kInlierM);
  found.inlier_share = static_cast<double>(evidence.inliers) / static_cast<double>(patches.size());
  found.rms_m = std::sqrt(evidence.inlier_squares_m2 / std::max(1, evidence.inliers));
  found.weakest_share = weakest_share(evidence);
}

}  // namespace

Result<PlaneRegistration> register_planes(const SweepPlanes& reference, const SweepPlanes& current,
                                          const std::optional<Pose>& guess) {
  constexpr int kPatches = 1200;
  constexpr AlignmentSettings kSettings{.coarse_patches = 400, .rounds = 5};
  constexpr int kLeastSupport = 12;
  const PlanesByDirection planes(reference);
  const auto patches = patches_of(current, kPatches);
  Registration found = align_patches(planes, patches, guess, kSettings);
  Support support;
  if (found.converged) {
    support = support_of(found.T_ref_cur, planes, patches);
    if (support.elsewhere > support.here) {
      found.T_ref_cur.translation() += support.to_elsewhere_m;
      refine(planes, patches, found);
      support = support_of(found.T_ref_cur, planes, patches);
    }
  }
  if (!found.converged || support.here < kLeastSupport || 2 * support.here < 3 * support.elsewhere) {
    return Error{ErrorCode::invalid_argument, "too few planes constrain the motion from frame " +
                                                  std::to_string(reference.frame) + " to " +
                                                  std::to_string(current.frame)};
  }
  return PlaneRegistration{found.T_ref_cur, found.inlier_share, found.rms_m, found.weakest_share};
}

}  // namespace pointreel
