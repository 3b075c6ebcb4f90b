// The wavefront: eight rows of an image are coded side by side, each a few columns behind the row above it.
//
//   row 0  . . . . . . . . . . x          x: the cells of one step; all that is left of them, and in the rows
//   row 1  . . . . . . x                  above up to kLag - 1 columns to the right, is coded already
//   row 2  . . x
//
// So eight cells are predicted at once, one a SIMD lane, from the very neighbours that raster order has.
// Arrays are skewed alike: what the lanes of a step need of one neighbour lies side by side in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pointreel {

struct Wavefront {
  static constexpr int kRows = 8;
  static constexpr int kLag = 4;     // columns by which a row is behind the one above it
  static constexpr int kMargin = 8;  // empty cells on either side of an image, so that none looks for borders

  // Steps for a block of rows; the last ones fill the margin of its last row.
  static constexpr int steps(int columns) { return columns + kLag * kRows; }
};

// A value a cell of eight rows, the two rows above them and the row below.
template <class T>
class SkewedPlane {
 public:
  static constexpr int kRowsAbove = 2, kRowsBelow = 1;
  static constexpr int kPitch = kRowsAbove + Wavefront::kRows + kRowsBelow;  // from one step to the next

  explicit SkewedPlane(int columns, T empty = T())
      : values_(static_cast<std::size_t>((kBlockLag + Wavefront::steps(columns) + kBorder) * kPitch), empty) {
  }

  // Values of the eight rows that are `rows_down` rows below those of the step, `columns_right` columns right
  // of its cells: eight side by side.
  T* at(int step, int columns_right = 0, int rows_down = 0) {
    return &values_[offset(step, columns_right, rows_down)];
  }
  const T* at(int step, int columns_right = 0, int rows_down = 0) const {
    return &values_[offset(step, columns_right, rows_down)];
  }

  // The values of a row, from -kRowsAbove to kRows + kRowsBelow - 1, to and from a row of an image.
  template <class Value>
  void set_row(int to_row, std::span<const Value> values) {
    T* to = at(0, 0, to_row);
    for (std::size_t column = 0; column < values.size(); ++column) to[column * kPitch] = values[column];
  }
  void get_row(int from_row, std::span<T> values) const {
    const T* from = at(0, 0, from_row);
    for (std::size_t column = 0; column < values.size(); ++column) values[column] = from[column * kPitch];
  }

  // After the values of a step are stored: those of the last rows are also the ones above the next block,
  // where they stand a block's rows further back in the wavefront, which this block has left behind.
  void keep_for_next_block(int step) {
    const T* from = at(step) + Wavefront::kRows - kRowsAbove;
    std::copy_n(from, kRowsAbove, &values_[static_cast<std::size_t>(step * kPitch)]);
  }

 private:
  static constexpr int kBorder = Wavefront::kMargin + Wavefront::kLag * kRowsAbove;
  static constexpr int kBlockLag = Wavefront::kLag * Wavefront::kRows;
  static_assert(kBlockLag >= kBorder);

  static std::size_t offset(int step, int columns_right, int rows_down) {
    return static_cast<std::size_t>(
        (step + columns_right + Wavefront::kLag * rows_down + kBlockLag) * kPitch + kRowsAbove + rows_down);
  }

  std::vector<T> values_;
};

}  // namespace pointreel
