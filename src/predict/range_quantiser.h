// How ranges are quantised.
#pragma once

#include <vector>

namespace pointreel {

// Ranges that a model can code, in steps.
inline constexpr float kMostRangeSteps = 1 << 24;

// Without a lattice the bins of a cell are centred on its prediction, which costs least; with one they are
// the multiples of step_m plus the row's phase, which hits the sensor's own values exactly.
struct RangeQuantiser {
  float step_m = 0.04F;
  std::vector<float> lattice_phase_m;  // per row of the image; empty: no lattice

  bool on_lattice() const { return !lattice_phase_m.empty(); }
};

}  // namespace pointreel
