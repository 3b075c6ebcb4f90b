// CodingGrid: how the cells of a sensor grid lie in the image that is predicted and coded.
#pragma once

#include <cstdint>
#include <vector>

#include "predict/grid_image.h"
#include "sensor/ray_table.h"

namespace pointreel {

// Cells of the sensor grid (row, firing column) are turned row by row, so that equal columns of the image
// look in equal directions.
class CodingGrid {
 public:
  CodingGrid(const SensorModel& model, const SweepGrid& grid)
      : rows_(model.row_count()), columns_(grid.column_count()), shifts_(column_shift_of_row(model, grid)) {
    const auto columns = static_cast<std::int64_t>(columns_);
    for (std::int32_t& shift : shifts_) {
      if (columns > 0) shift = static_cast<std::int32_t>(((shift % columns) + columns) % columns);
    }
  }

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  GridImage empty_image() const {
    return {static_cast<int>(rows_), static_cast<int>(columns_), std::vector<float>(rows_ * columns_)};
  }

  // Index in the image of a cell of the sensor grid.
  std::size_t image_index(std::size_t row, std::size_t column) const {
    const std::size_t turned = column + static_cast<std::size_t>(shifts_[row]);
    return row * columns_ + (turned < columns_ ? turned : turned - columns_);
  }
  std::size_t image_index(std::size_t cell) const { return image_index(cell / columns_, cell % columns_); }

 private:
  std::size_t rows_, columns_;
  std::vector<std::int32_t> shifts_;
};

}  // namespace pointreel
