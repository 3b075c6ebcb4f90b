#include "motion/registration.h"

#include "motion/patch_alignment.h"
#include "motion/surface_patches.h"

namespace pointreel {
namespace {

// The returns of a sweep.
struct GridReference {
  GridRays rays;

  std::optional<Eigen::Vector3f> partner_m(const Eigen::Vector3f& p_m, const Eigen::Vector3f&) const {
    const GridRays::Cell cell = rays.return_near(p_m);
    if (cell.row < 0) return std::nullopt;
    return rays.point_m(cell.row, cell.column);
  }
};

}  // namespace

Registration register_sweeps(const RangeGrid& reference, const RangeGrid& current,
                             const std::optional<Pose>& guess, const RegistrationSettings& settings) {
  const GridReference reference_returns{GridRays(reference)};
  const auto patches = find_surface_patches(GridRays(current), settings.patches);
  return align_patches(reference_returns, patches, guess, settings);
}

}  // namespace pointreel
