// GridImage: the ranges of a sweep on its sensor's grid, as they are predicted and coded.
#pragma once

#include <cstddef>
#include <vector>

namespace pointreel {

// Rows from top to bottom, columns cyclic; equal columns of different rows look in equal directions.
struct GridImage {
  int rows = 0;
  int columns = 0;
  std::vector<float> range_m;  // row-major; 0: no return

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

}  // namespace pointreel
