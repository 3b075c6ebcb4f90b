// warp: an earlier sweep as this one's sensor would see it from where it stands now.
#pragma once

#include "motion/sweep_motion.h"
#include "predict/reference_image.h"
#include "predict/reference_sweep.h"
#include "predict/warp_canvas.h"
#include "predict/warped_points.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// What one sweep after the other takes for warping.
struct WarpMemory {
  WarpedPoints points;
  WarpCanvas canvas;
  ReferenceImage image;
};

// Every point of the reference moves into the current sweep's coordinates (`motion` leads back); the cell
// of the grid nearest to it takes the range at which its ray meets the surface that the point and its
// neighbours span. Of several points the nearest wins. Cells without a point that surfaces beside them go on
// into count as filled. Deterministic on all machines and for any number of threads.
// The image is that of `memory`, until the next call.
const ReferenceImage& warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                           const SweepMotion& motion, int threads, WarpMemory& memory);

}  // namespace pointreel
