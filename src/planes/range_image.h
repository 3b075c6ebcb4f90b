// One range per cell of the angular grid, over the band of rows that a sweep uses.
#pragma once

#include <cstddef>
#include <vector>

namespace pointreel {

struct RangeImage {
  int first_row = 0;           // grid row of image row 0; a multiple of the tile size
  int rows = 0;                // a multiple of the tile size
  int columns = 0;             // the grid's
  std::vector<float> range_m;  // row-major; 0 = no return

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  float at(int row, int column) const { return range_m[index(row, column)]; }
  float& at(int row, int column) { return range_m[index(row, column)]; }
  bool occupied(int row, int column) const { return at(row, column) > 0; }
};

}  // namespace pointreel
