// The lattice on which a sensor measures ranges, seen through the rounding of the file's coordinates.
#pragma once

#include <complex>
#include <vector>

#include "sensor/row_samples.h"
#include "sensor/sensor_model.h"

namespace pointreel {

// Collects ranges sweep by sweep.
class RangeLattice {
 public:
  void add(const RowSamples& samples);

  // Sets range_step_m and range_phase of a model: the coarsest step that nearly all rows agree with, or none.
  // `base`: the model that the samples were taken with.
  void write_to(SensorModel& model, const SensorModel& base) const;

 private:
  // Per candidate step and row: the sum of the ranges' phases.
  std::vector<std::vector<std::complex<double>>> sums_;
  std::vector<std::size_t> points_;  // per row
};

}  // namespace pointreel
