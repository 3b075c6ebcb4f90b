// How far decoded points are from the originals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pointreel/codec.h"

namespace pointreel {

struct ErrorSummary {
  std::size_t count = 0;
  double sum_m = 0, sum_squares_m2 = 0, max_m = 0;

  void add(double error_m);
  void merge(const ErrorSummary& other);
  double mean_m() const { return count == 0 ? 0 : sum_m / static_cast<double>(count); }
  double rms_m() const;
};

struct SweepQuality {
  std::size_t points_in = 0, points_out = 0, non_finite = 0;
  std::size_t points_lost = 0;    // finite points without an own decoded point
  double farthest_m = 0;          // range of the farthest kept point, as below
  ErrorSummary paired;            // each kept point to its own decoded point
  ErrorSummary paired_range;      // of which along the ray, seen from the frame the range image lives in
  ErrorSummary paired_angular;    // of which across it: rounding to the cell's centre
  ErrorSummary nearest_decoded;   // every finite original point to the nearest decoded one
  ErrorSummary nearest_original;  // every decoded point to the nearest original one

  void merge(const SweepQuality& other);
};

// `pairs` as pair_points() gives them.
SweepQuality measure_quality(const PointCloud& original, const DecodedSweep& decoded,
                             const std::vector<std::int64_t>& pairs);

// The same without the nearest neighbours, which take most of the time.
SweepQuality measure_pairs(const PointCloud& original, const DecodedSweep& decoded,
                           const std::vector<std::int64_t>& pairs);

// Median and the like of a list of timings; 0 for an empty one. `share` in [0, 1].
double quantile(std::vector<double> values, double share);

}  // namespace pointreel
