// Runs: the pieces of a row-major cloud, each once around in one row.
#pragma once

#include <cstddef>
#include <vector>

#include "sensor/polar_points.h"

namespace pointreel {

struct RowRuns {
  std::vector<std::size_t> first;  // index of each run's first point
  bool descending = false;         // the azimuth falls along a run
  std::size_t runs() const { return first.size(); }
  std::size_t end(std::size_t run, std::size_t points) const {
    return run + 1 < first.size() ? first[run + 1] : points;
  }
};

// A new run starts where the azimuth jumps back by more than 1 rad; it is taken in [0, 2 pi) or in [-pi, pi),
// whichever makes the straighter runs.
RowRuns split_into_runs(const PolarPoints& polar, int threads = 1);

}  // namespace pointreel
