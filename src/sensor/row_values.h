// What the model says of the row of each of a block of points, side by side for loops that become SIMD code.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sensor/sensor_model.h"

namespace pointreel {

// One value a row; a model without rows has one, too, looked at for points without a row.
class RowValues {
 public:
  RowValues(const SensorModel& model, double RowModel::*value) {
    for (const RowModel& row : model.rows) of_row_.push_back(static_cast<float>(row.*value));
    if (of_row_.empty()) of_row_.push_back(0);
  }
  float operator[](std::int16_t row) const { return of_row_[row < 0 ? 0 : static_cast<std::size_t>(row)]; }

 private:
  std::vector<float> of_row_;
};

class RowBlock {
 public:
  RowBlock(const std::int16_t* rows, std::size_t count) : rows_(rows), count_(count) {
    int other_rows = 0;
    for (std::size_t k = 0; k < count; ++k) other_rows |= rows[k] != rows[0] ? 1 : 0;
    one_row_ = other_rows == 0;
  }
  void spread(const RowValues& of_row, float* values) const {
    if (one_row_) {  // as a rule, where row follows row
      std::fill_n(values, count_, of_row[rows_[0]]);
    } else {
      for (std::size_t k = 0; k < count_; ++k) values[k] = of_row[rows_[k]];
    }
  }

 private:
  const std::int16_t* rows_;
  std::size_t count_;
  bool one_row_;
};

}  // namespace pointreel
