// The series of the study: which settings it compares.
#pragma once

#include <string_view>
#include <vector>

#include "measurement.h"

namespace pointreel {

struct Series {
  std::string_view name;  // of the CSV file
  std::vector<Setting> settings;
  bool timed = false;  // measured several times, because its times are the point
};

// Rate, errors and times against threshold, resolution, group size, tile size and residuals, and motion.
// Groups larger than the set are left out.
std::vector<Series> study_series(const SweepSet& set, int threads);

// The settings of which the speed-up over one thread is asked: the default group on each number of threads,
// and small to large groups on `threads`.
std::vector<Setting> speedup_settings(const SweepSet& set, int threads);

}  // namespace pointreel
