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
#include <vector>

namespace pointreel {

struct Wavefront {
  static constexpr int kRows = 8;
  static constexpr int kLag = 4;     // columns by which a row is behind the one above it
  static constexpr int kMargin = 8;  // empty cells on either side of an image, so that none looks for borders

  // Steps for a block of rows; the last ones fill the margin of its last row.
  static constexpr int steps(int columns) { return columns + kLag * kRows; }
};

// kDepth values a cell of eight rows, the two rows above them and the row below.
template <class T, int kDepth = 1>
class SkewedPlane {
 public:
  static constexpr int kRowsAbove = 2, kRowsBelow = 1;
  static constexpr int kPitch = kRowsAbove + Wavefront::kRows + kRowsBelow;  // from one of kDepth to the next

  explicit SkewedPlane(int columns, T empty = T())
      : values_(static_cast<std::size_t>((Wavefront::steps(columns) + 2 * kBorder) * kDepth * kPitch),
                empty) {}

  // Values of the eight rows that are `rows_down` rows below those of the step, `columns_right` columns right
  // of its cells: eight side by side.
  T* at(int step, int columns_right = 0, int rows_down = 0) {
    return &values_[offset(step, columns_right, rows_down)];
  }
  const T* at(int step, int columns_right = 0, int rows_down = 0) const {
    return &values_[offset(step, columns_right, rows_down)];
  }
  // The first value of a row, from -kRowsAbove to kRows + kRowsBelow - 1; the next one is kDepth * kPitch on.
  T* row(int row) {
    return &values_[static_cast<std::size_t>((Wavefront::kLag * row + kBorder) * kDepth * kPitch +
                                             kRowsAbove + row)];
  }

  // The last rows of this block become those above the next: of each cell's values the same ones, a block's
  // rows further on in the wavefront.
  void start_next_block() {
    constexpr std::size_t kApart = std::size_t{Wavefront::kLag} * Wavefront::kRows * kDepth * kPitch;
    for (std::size_t to = 0; to + kApart < values_.size(); to += kPitch)
      std::copy_n(&values_[to + kApart + Wavefront::kRows], kRowsAbove, &values_[to]);
  }

 private:
  static constexpr int kBorder = Wavefront::kMargin + Wavefront::kLag * kRowsAbove;

  static std::size_t offset(int step, int columns_right, int rows_down) {
    return static_cast<std::size_t>((step + columns_right + Wavefront::kLag * rows_down + kBorder) * kDepth *
                                        kPitch +
                                    kRowsAbove + rows_down);
  }

  std::vector<T> values_;
};

}  // namespace pointreel
