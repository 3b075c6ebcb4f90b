// register_planes: tiles of the later sweep's planes against the planes of the earlier one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>

#include "base/trigonometry.h"
#include "motion/patch_alignment.h"
#include "pointreel/planes.h"

namespace pointreel {
namespace {

// The planes of a sweep by direction: about two tiles of a 64-row sensor a bin.
class PlanesByDirection {
 public:
  explicit PlanesByDirection(const SweepPlanes& sweep) : first_(kAcross * kUp + 1) {
    planes_.reserve(sweep.planes.size());
    for (const SweepPlane& plane : sweep.planes)
      planes_.push_back({plane.normal.cast<float>(), static_cast<float>(plane.distance_m)});
    std::vector<std::size_t> bin_of_tile;
    bin_of_tile.reserve(sweep.tiles.size());
    for (const PlaneTile& tile : sweep.tiles) {
      const Bin bin = bin_of(tile.center_m);
      bin_of_tile.push_back(index(bin.across, std::clamp(bin.up, 0, kUp - 1)));
      ++first_[bin_of_tile.back() + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    tiles_.resize(sweep.tiles.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < sweep.tiles.size(); ++i)
      tiles_[next[bin_of_tile[i]]++] = {sweep.tiles[i].center_m, sweep.tiles[i].plane};
  }

  // For align_patches.
  void measure(PatchBlock& block) const {
    for (std::size_t i = 0; i < block.count; ++i) {
      const Eigen::Vector3f p_m = block.center_m(i), normal = block.normal(i);
      const auto partner = partner_m(p_m, normal);
      block.distance_m[i] = partner ? normal.dot(p_m - *partner) : PatchBlock::kNoPartner;
    }
  }

 private:
  // Where the plane of the nearest tile that faces the same way is nearest to a point.
  std::optional<Eigen::Vector3f> partner_m(const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal) const {
    constexpr float kSameDirection = 0.97F;
    constexpr float kFarthestShare = 0.1F, kFarthestM = 0.5F;  // of a tile's center from the point
    const Bin bin = bin_of(p_m);
    const float most_m = kFarthestM + kFarthestShare * p_m.norm();
    float nearest_m2 = most_m * most_m;
    const Facet* nearest = nullptr;
    const auto look_at = [&](int first_across, int last_across, int up) {
      const std::uint32_t end = first_[index(last_across, up) + 1];
      for (std::uint32_t i = first_[index(first_across, up)]; i < end; ++i) {
        const float away_m2 = (tiles_[i].center_m - p_m).squaredNorm();
        if (!(away_m2 < nearest_m2)) continue;
        const Facet& facet = planes_[tiles_[i].plane];
        if (!(facet.normal.dot(normal) > kSameDirection)) continue;
        nearest_m2 = away_m2;
        nearest = &facet;
      }
    };
    for (int up = std::max(0, bin.up - 1); up <= std::min(kUp - 1, bin.up + 1); ++up) {
      look_at(std::max(0, bin.across - 1), std::min(kAcross - 1, bin.across + 1), up);
      if (bin.across == 0) look_at(kAcross - 1, kAcross - 1, up);  // around the seam
      if (bin.across == kAcross - 1) look_at(0, 0, up);
    }
    if (nearest == nullptr) return std::nullopt;
    return p_m - (nearest->normal.dot(p_m) - nearest->distance_m) * nearest->normal;
  }

  static constexpr int kAcross = 256, kUp = 64;
  static constexpr float kLowestSlope = -0.8F, kBinsPerSlope = 60;
  struct Facet {
    Eigen::Vector3f normal;
    float distance_m;
  };
  struct Tile {
    Eigen::Vector3f center_m;
    std::uint32_t plane;
  };
  struct Bin {
    int across, up;
  };
  static Bin bin_of(const Eigen::Vector3f& p_m) {
    constexpr auto kBinsPerRad = static_cast<float>(kAcross / (2 * kPi));
    const float rho_m = std::sqrt(p_m.x() * p_m.x() + p_m.y() * p_m.y());
    const float up = (p_m.z() / std::max(rho_m, 0.1F) - kLowestSlope) * kBinsPerSlope;
    return {static_cast<int>((fast_atan2(p_m.y(), p_m.x()) + static_cast<float>(kPi)) * kBinsPerRad) &
                (kAcross - 1),
            static_cast<int>(std::clamp(up, -2.0F, static_cast<float>(kUp + 1)))};
  }
  static std::size_t index(int across, int up) {
    return static_cast<std::size_t>(up) * kAcross + static_cast<std::size_t>(across);
  }

  std::vector<Facet> planes_;
  std::vector<std::uint32_t> first_;  // tile of each bin, and one past the last
  std::vector<Tile> tiles_;
};

// Tiles spread over all directions they face.
std::vector<SurfacePatch> patches_of(const SweepPlanes& sweep, int most) {
  std::vector<SurfacePatch> patches;
  const std::size_t count = sweep.tiles.size();
  if (count == 0) return patches;
  auto step = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
  while (std::gcd(step, count) != 1) ++step;
  std::array<int, kFacings> count_facing{};
  for (std::size_t i = 0, tile = 0; i < count && static_cast<int>(patches.size()) < most; ++i) {
    tile = (tile + step) % count;
    const Eigen::Vector3f normal = sweep.planes[sweep.tiles[tile].plane].normal.cast<float>();
    int& facing_alike = count_facing[static_cast<std::size_t>(facing(normal))];
    if (facing_alike >= most / 3) continue;
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
  constexpr std::size_t kMostPatches = 100;
  constexpr double kStepM = 0.3;
  constexpr int kSteps = 10;  // to each side; the first is still here
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
                   [&](const Eigen::Vector3f&, const Eigen::Vector3f&, float distance_m) {
                     inliers += std::fabs(distance_m) < kInlierM ? 1 : 0;
                   });
    if (step == 0) support.here = inliers;
    if (std::abs(step) < 2 || inliers <= support.elsewhere) continue;
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
  constexpr RegistrationSettings kSettings{900, 500, 5};
  constexpr int kLeastSupport = 8;
  const PlanesByDirection planes(reference);
  const auto patches = patches_of(current, kSettings.patches);
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
