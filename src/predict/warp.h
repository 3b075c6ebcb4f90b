// warp: an earlier sweep as this one's sensor would see it from where it stands now.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pointreel/motion.h"
#include "predict/reference_image.h"
#include "predict/reference_sweep.h"
#include "predict/warped_points.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// The image while it is rendered: the cells with a row above and a row below.
struct WarpCanvas {
  int columns = 0;
  std::vector<float> range_m;      // weighted sums
  std::vector<float> weight;       // their weights; 0: nothing yet
  std::vector<std::uint8_t> hits;  // HitReference bits; the extra rows are hit, so that nobody fills them

  void clear(int image_rows, int image_columns) {
    columns = image_columns;
    const std::size_t size = static_cast<std::size_t>(image_rows + 2) * static_cast<std::size_t>(columns);
    range_m.resize(size);
    weight.assign(size, 0);
    hits.assign(size, 0);
    std::fill(hits.begin(), hits.begin() + columns, kWarpedHit);
    std::fill(hits.end() - columns, hits.end(), kWarpedHit);
  }
  std::int32_t first_of_row(int row) const { return (row + 1) * columns; }
};

// What one sweep after the other takes for warping.
struct WarpMemory {
  WarpedPoints points;
  WarpCanvas canvas;
  ReferenceImage image;
};

// Every point of the reference moves into the current sweep's coordinates (`T_ref_cur` leads back) and falls
// between four cells of the grid; each of them takes the range at which its own ray meets the surface that
// the point and its neighbours span. Of several points the nearest wins; cells that only the far side of a
// point reaches count as filled. Deterministic on all machines and for any number of threads.
// The image is that of `memory`, until the next call.
const ReferenceImage& warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                           const Pose& T_ref_cur, int threads, WarpMemory& memory);

}  // namespace pointreel
