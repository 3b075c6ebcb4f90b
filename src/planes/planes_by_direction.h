// PlanesByDirection: a sweep's planes as what patches of another sweep are registered against.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/patch_block.h"
#include "pointreel/planes.h"

namespace pointreel {

// Where the sensor looks, in steps: about one tile of a 64-row sensor a bin. Around the seam, the last and
// the first bin exist twice; above and below are bins without tiles.
struct DirectionBins {
  static constexpr std::int32_t kAcross = 256, kUp = 64, kBeyond = 3;
  static constexpr float kLowestSlope = -0.8F, kBinsPerSlope = 60;
  static constexpr std::int32_t kStride = kAcross + 2, kCount = kStride * (kUp + 2 * kBeyond);

  // From a bin with all eight around it to another: `across` -1 to kAcross, `up` -kBeyond to kUp + kBeyond
  // - 1.
  static constexpr std::int32_t index(std::int32_t across, std::int32_t up) {
    return (up + kBeyond) * kStride + across + 1;
  }
};

class PlanesByDirection {
 public:
  explicit PlanesByDirection(const SweepPlanes& sweep);

  // For align_patches: how far the point of each patch is from where the plane of the nearest tile that faces
  // the same way is nearest to it, along the patch's normal.
  void measure(PatchBlock& block) const;
  static constexpr float motion_per_turn = 0;  // not known here: all is taken as seen at once

  // Sorted by bin, for SIMD code, which looks at kAtOnce of them: as many follow that are nowhere.
  struct Tiles {
    std::vector<std::int32_t> first_of_bin;                       // and one past the last
    std::vector<float> x_m, y_m, z_m;                             // of the centers
    std::vector<float> normal_x, normal_y, normal_z, distance_m;  // of the planes
  };
  static constexpr std::size_t kAtOnce = 8;

 private:
  Tiles tiles_;
};

}  // namespace pointreel
