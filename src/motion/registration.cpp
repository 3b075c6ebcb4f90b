#include "motion/registration.h"

#include "motion/grid_matching.h"
#include "motion/patch_alignment.h"
#include "motion/surface_patches.h"

namespace pointreel {
namespace {

// The returns of a sweep.
struct GridReference {
  const GridRays& rays;
  void measure(PatchBlock& block) const { measure_patches(rays, block); }
};

}  // namespace

Registration register_sweeps(const GridRays& reference, const GridRays& current,
                             const std::optional<Pose>& guess, const RegistrationSettings& settings) {
  return align_patches(GridReference{reference}, find_surface_patches(current, settings.patches), guess,
                       settings);
}

}  // namespace pointreel
