// The study's tables: one CSV file a series, a header line, one row a setting.
#pragma once

#include <filesystem>
#include <vector>

#include "study_series.h"

namespace pointreel {

// Measures the series and writes its file into `folder`, with a line a row on standard output. Throws
// std::runtime_error.
void write_series(const Series& series, const SweepSet& set, int repeats,
                  const std::filesystem::path& folder);

// speedup.csv: each setting against the same on one thread. The two are measured in turn, so that whatever
// else the machine does hits both, and the medians of the ratios are written.
void write_speedup(const std::vector<Setting>& settings, const SweepSet& set, int repeats,
                   const std::filesystem::path& folder);

}  // namespace pointreel
