// One setting of method `planes` on one set of sweeps: its rate, errors and times.
#pragma once

#include <cstdint>
#include <vector>

#include "common/quality.h"
#include "pointreel/codec.h"
#include "sweep_set.h"

namespace pointreel {

struct Setting {
  PlanesOptions planes{.grid = PlaneGrid::uniform};
  MotionSource motion = MotionSource::none;
  int threads = 0;  // 0: one per processor
};

// Mean over the sweeps of one pass.
struct SweepTimes {
  double encode_ms = 0;
  double decode_ms = 0;
};

struct Measurement {
  std::uint64_t bytes = 0;   // of the whole file: header, packets, index
  double range_bound_m = 0;  // what the stream promises for the range of a kept point
  FrameStatistics parts;     // sums over all sweeps
  SweepQuality quality;      // nearest neighbours of `nearest_sweeps` only
  std::size_t nearest_sweeps = 0;
  SweepTimes times;
};

// Encodes into a .reel in memory, reads that back, decodes, and compares every point with its own.
// Nearest neighbours take longer than all the rest together, so only those of `nearest_sweeps` evenly spaced
// sweeps are looked for. Throws std::runtime_error.
Measurement measure(const SweepSet& set, const Setting& setting, std::size_t nearest_sweeps);

// Another pass for the clock alone.
SweepTimes measure_times(const SweepSet& set, const Setting& setting);

}  // namespace pointreel
