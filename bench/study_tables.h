// The study's tables: one CSV file a series, a header line, one row a setting.
#pragma once

#include <filesystem>
#include <vector>

#include "study_series.h"

namespace pointreel {

struct StudyOptions {
  int repeats = 3;                 // passes of the series about speed
  std::size_t nearest_sweeps = 5;  // of 30 sweeps, these fall on each place of the default group once
  std::filesystem::path folder;    // for the files
};

// Measures the series and writes its file, with a line a row on standard output. Throws std::runtime_error.
void write_series(const Series& series, const SweepSet& set, const StudyOptions& options);

// speedup.csv: each setting against the same on one thread. The two are measured in turn, so that whatever
// else the machine does hits both, and the medians of the ratios are written.
void write_speedup(const std::vector<Setting>& settings, const SweepSet& set, const StudyOptions& options);

}  // namespace pointreel
