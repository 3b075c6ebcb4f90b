#include "predict/reference_sweep.h"

#include "base/parallel.h"
#include "predict/coding_grid.h"
#include "sensor/ray_table.h"

namespace pointreel {

ReferenceSweep reference_from(const SensorModel& model, const SweepGrid& grid, std::span<const float> range_m,
                              int threads) {
  const CodingGrid coding(model, grid);
  SweepGrid measured = grid;
  measured.motion.reset();
  const RayTable rays(model, measured);
  ReferenceSweep reference{static_cast<int>(coding.rows()), static_cast<int>(coding.columns()),
                           {range_m.begin(), range_m.end()}, {}, {}, {}, grid};
  for (auto* axis : {&reference.x_m, &reference.y_m, &reference.z_m}) axis->resize(range_m.size());
  parallel_for(coding.rows(), threads, [&](std::size_t row) {
    std::vector<float> row_range_m(coding.columns());
    std::vector<Point3f> positions(coding.columns());
    for (std::size_t column = 0; column < coding.columns(); ++column)
      row_range_m[column] = range_m[coding.image_index(row, column)];
    rays.positions_of_row(row, row_range_m, positions);
    for (std::size_t column = 0; column < coding.columns(); ++column) {
      if (!(row_range_m[column] > 0)) continue;
      const std::size_t cell = coding.image_index(row, column);
      reference.x_m[cell] = positions[column].x;
      reference.y_m[cell] = positions[column].y;
      reference.z_m[cell] = positions[column].z;
    }
  });
  return reference;
}

}  // namespace pointreel
