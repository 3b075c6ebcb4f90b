// Where the sweeps of a live encode come from.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

using ArrivalClock = std::chrono::steady_clock;

struct ArrivedSweep {
  std::string name;          // for messages: its file, or its number in the stream
  Result<PointCloud> cloud;  // an error is this sweep's only: the next one may be good
  std::optional<ArrivalClock::time_point>
      arrived;  // when it was complete; none if that was before anyone looked
};

class SweepSource {
 public:
  virtual ~SweepSource() = default;
  // Waits for the next sweep; none when there will be no more.
  virtual std::optional<ArrivedSweep> next() = 0;
};

}  // namespace pointreel
