// WarpedPoints: where the points of a reference sweep fall in the image of this one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointreel {

// Neighbours of a point that lie on the same surface.
enum SurfaceSide : std::int32_t { kRight = 1, kLeft = 2, kBelow = 4, kAbove = 8 };

// Arrays in the layout of the reference, with empty points around: neighbours need no borders, and neither do
// vectors of eight that begin within a row.
struct WarpedPoints {
  static constexpr std::size_t kMargin = 8;

  // First step: the points. Places are between cells, at fractions of rows and columns.
  std::vector<float> row, column;
  std::vector<float> inverse_rho;  // 1 / distance from the axis: linear along a plane
  std::vector<float> range_m;      // of the reference; 0: no point
  // Second step: their surfaces, and what they say about the cells nearest to them.
  std::vector<std::int32_t> sides;         // SurfaceSide bits
  std::vector<std::int32_t> nearest_cell;  // as in WarpCanvas; kNone where that is outside the image
  std::vector<float> nearest_range_m;      // where the nearest cell's ray meets the surface
  std::vector<float> nearest_weight;       // how near

  static constexpr std::int32_t kNone = -1;

  // Keeps memory, and the empty margins, from a sweep of the same layout.
  void lay_out(int rows, int columns) {
    const std::size_t stride = (static_cast<std::size_t>(columns) + 2 * kMargin + 7) / 8 * 8;
    const std::size_t size = stride * (static_cast<std::size_t>(rows) + 2);
    if (stride == stride_ && size == row.size()) return;
    stride_ = stride;
    for (auto* values : {&row, &column, &inverse_rho, &range_m, &nearest_range_m, &nearest_weight})
      values->assign(size, 0);
    for (auto* values : {&sides, &nearest_cell}) values->assign(size, 0);
  }
  std::size_t index(int at_row, int at_column) const {
    return static_cast<std::size_t>(at_row + 1) * stride_ + kMargin + static_cast<std::size_t>(at_column);
  }
  std::size_t stride() const { return stride_; }

 private:
  std::size_t stride_ = 0;
};

}  // namespace pointreel
