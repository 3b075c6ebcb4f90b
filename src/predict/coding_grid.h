// CodingGrid: how the cells of a sensor grid lie in the image that is predicted and coded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
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
  // Columns by which a row is turned: below columns(), if there are any.
  std::size_t shift(std::size_t row) const { return static_cast<std::size_t>(shifts_[row]); }
  GridImage empty_image() const {
    return {static_cast<int>(rows_), static_cast<int>(columns_), std::vector<float>(rows_ * columns_)};
  }

  // Ranges of the cells, empty ones 0, row after row: of the sensor grid and of the image.
  GridImage image_of(std::span<const float> range_of_cell_m, int threads) const {
    GridImage image = empty_image();
    parallel_for(rows_, threads, [&](std::size_t row) {
      const auto from = range_of_cell_m.begin() + offset(row * columns_);
      const auto to = image.range_m.begin() + offset(row * columns_);
      std::rotate_copy(from, from + offset(columns_ - shift(row)), from + offset(columns_), to);
    });
    return image;
  }
  std::vector<float> ranges_of_cells(const GridImage& image, int threads) const {
    std::vector<float> range_of_cell_m(image.range_m.size());
    parallel_for(rows_, threads, [&](std::size_t row) {
      const auto from = image.range_m.begin() + offset(row * columns_);
      const auto to = range_of_cell_m.begin() + offset(row * columns_);
      std::rotate_copy(from, from + offset(shift(row)), from + offset(columns_), to);
    });
    return range_of_cell_m;
  }

  // Index in the image of a cell of the sensor grid.
  std::size_t image_index(std::size_t cell) const { return Finder(*this)(cell); }

  // The same for cells asked for one after the other: fast within a row.
  class Finder {
   public:
    explicit Finder(const CodingGrid& grid) : grid_(grid) {}
    std::size_t operator()(std::size_t cell) {
      if (cell < first_ || cell >= end_) {
        const std::size_t row = cell / grid_.columns_;
        first_ = row * grid_.columns_;
        end_ = first_ + grid_.columns_;
        shift_ = grid_.shift(row);
      }
      const std::size_t turned = cell + shift_;
      return turned < end_ ? turned : turned - grid_.columns_;
    }

   private:
    const CodingGrid& grid_;
    std::size_t first_ = 0, end_ = 0, shift_ = 0;
  };

 private:
  static std::ptrdiff_t offset(std::size_t index) { return static_cast<std::ptrdiff_t>(index); }

  std::size_t rows_, columns_;
  std::vector<std::int32_t> shifts_;
};

}  // namespace pointreel
