// ReferenceSweep: what both sides keep of a decoded sweep to predict later ones from.
#pragma once

#include <vector>

#include "predict/band_coding.h"
#include "predict/grid_image.h"
#include "predict/reference_image.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

struct ReferenceSweep {
  SweepGrid grid;
  GridImage image;  // decoded, in predicted frames drawn towards what those before said
  // What coding it has taught, at the end of each band, where it was itself predicted: the next sweep goes on
  // from there.
  std::vector<BandState> states;
};

// Draws the decoded ranges of a predicted sweep towards what the sweeps before it say, as far as both show
// the same surface: noise and rounding average out over the sweeps. `step_m`: the quantiser's.
void draw_together(const ReferenceImage& warped, float step_m, GridImage& decoded);

}  // namespace pointreel
