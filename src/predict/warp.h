// warp: an earlier sweep as this one's sensor would see it from where it stands now.
#pragma once

#include "pointreel/motion.h"
#include "predict/reference_image.h"
#include "predict/reference_sweep.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Every point of the reference moves into the current sweep's coordinates (`T_ref_cur` leads back) and falls
// between four cells of the grid; each of them takes the range at which its own ray meets the surface that
// the point and its neighbours span. Of several points the nearest wins; cells that only the far side of a
// point reaches count as filled. Deterministic on all machines and for any number of threads.
ReferenceImage warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                    const Pose& T_ref_cur, int threads);

}  // namespace pointreel
