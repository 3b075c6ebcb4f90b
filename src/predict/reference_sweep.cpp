#include "predict/reference_sweep.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "predict/coding_grid.h"
#include "sensor/ray_table.h"

namespace pointreel {

void draw_together(const ReferenceImage& warped, float step_m, GridImage& decoded) {
  constexpr float kShare = 0.3F;
  const float most_m = 0.3F * step_m;          // within the bin, which is sure
  const float same_m = 1.5F * step_m + 0.02F;  // farther apart it is another surface
  for (std::size_t i = 0; i < decoded.range_m.size(); ++i) {
    const float decoded_m = decoded.range_m[i];
    const float apart_m = warped.range_m[i] - decoded_m;
    if (!(decoded_m > 0) || !(warped.range_m[i] > 0) || !(std::fabs(apart_m) < same_m)) continue;
    decoded.range_m[i] = decoded_m + std::min(std::max(kShare * apart_m, -most_m), most_m);
  }
}

ReferenceSweep reference_from(const SensorModel& model, const SweepGrid& grid, std::span<const float> range_m,
                              std::vector<BandState> states, int threads) {
  const CodingGrid coding(model, grid);
  SweepGrid measured = grid;
  measured.motion.reset();
  const RayTable rays(model, measured);
  ReferenceSweep reference{static_cast<int>(coding.rows()),
                           static_cast<int>(coding.columns()),
                           {range_m.begin(), range_m.end()},
                           {},
                           {},
                           {},
                           grid,
                           std::move(states)};
  for (auto* axis : {&reference.x_m, &reference.y_m, &reference.z_m}) axis->resize(range_m.size());
  parallel_for(coding.rows(), threads, [&](std::size_t row) {
    const auto first = static_cast<std::ptrdiff_t>(row * coding.columns());
    const auto end = first + static_cast<std::ptrdiff_t>(coding.columns());
    const auto turned = first + static_cast<std::ptrdiff_t>(coding.shift(row));
    std::vector<float> row_range_m(coding.columns());
    std::rotate_copy(range_m.begin() + first, range_m.begin() + turned, range_m.begin() + end,
                     row_range_m.begin());
    std::vector<Point3f> positions(coding.columns());
    rays.positions_of_row(row, row_range_m, positions);
    CodingGrid::Finder image_index(coding);
    for (std::size_t column = 0; column < coding.columns(); ++column) {
      if (!(row_range_m[column] > 0)) continue;
      const std::size_t cell = image_index(row * coding.columns() + column);
      reference.x_m[cell] = positions[column].x;
      reference.y_m[cell] = positions[column].y;
      reference.z_m[cell] = positions[column].z;
    }
  });
  return reference;
}

}  // namespace pointreel
