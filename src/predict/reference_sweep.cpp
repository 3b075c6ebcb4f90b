#include "predict/reference_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pointreel {

void draw_together(const ReferenceImage& warped, float step_m, GridImage& decoded) {
  constexpr float kShare = 0.3F;
  const float most_m = 0.3F * step_m;          // within the bin, which is sure
  const float same_m = 1.5F * step_m + 0.02F;  // farther apart it is another surface
  float* range_m = decoded.range_m.data();
  const float* warped_m = warped.range_m.data();
  for (std::size_t i = 0; i < decoded.range_m.size(); ++i) {  // free of branches, as compilers like it
    const float decoded_m = range_m[i];
    const float apart_m = warped_m[i] - decoded_m;
    const float drawn_m = decoded_m + std::min(std::max(kShare * apart_m, -most_m), most_m);
    const bool same = (decoded_m > 0) & (warped_m[i] > 0) & (std::fabs(apart_m) < same_m);
    range_m[i] = same ? drawn_m : decoded_m;
  }
}

}  // namespace pointreel
