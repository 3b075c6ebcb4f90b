// Better rows from more sweeps: corrections of slope, offset, azimuth and side offset, by least squares
// around the rows of the first sweep.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "sensor/row_samples.h"
#include "sensor/sensor_model.h"

namespace pointreel {

class RowRefinement {
 public:
  explicit RowRefinement(SensorModel model) : base_(std::move(model)), rows_(base_.rows.size()) {}

  // What the samples are taken with.
  const SensorModel& base() const { return base_; }
  void add(const RowSamples& samples);

  // The rows as all sweeps so far have them; everything else as in the first model.
  SensorModel refined() const;

 private:
  // Weighted sums of a line through residuals y at places x.
  struct Line {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    void add(double at, double value, double weight);
    // Constant and slope of the line; only a constant where the places hardly differ.
    std::array<double, 2> solve() const;
  };
  struct Row {
    Line height;  // metres, over rho
    Line turn;    // radians, over 1 / rho
  };
  SensorModel base_;
  std::vector<Row> rows_;
};

}  // namespace pointreel
