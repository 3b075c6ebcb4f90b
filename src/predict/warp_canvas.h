// WarpCanvas: the image of a warped reference while it is rendered.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "predict/reference_image.h"

namespace pointreel {

// The cells of the image with an empty row above and one below, and kMargin cells on either side of each row
// that show its other end: neighbours need no borders, and neither do vectors of eight that begin in a row.
struct WarpCanvas {
  static constexpr int kMargin = 8;

  int rows = 0, columns = 0, stride = 0;
  std::vector<float> weight;        // 0: no point
  std::vector<float> range_m;       // weighted sums, if there is a point; once averaged means, or 0
  std::vector<std::int32_t> sides;  // of the points in a cell: where their surfaces go on (SurfaceSide bits)

  void clear(int image_rows, int image_columns) {
    rows = image_rows;
    columns = image_columns;
    stride = (columns + 2 * kMargin + 7) / 8 * 8;
    const std::size_t size = static_cast<std::size_t>(rows + 2) * static_cast<std::size_t>(stride);
    range_m.resize(size);
    sides.resize(size);
    weight.assign(size, 0);
    std::fill_n(range_m.begin(), stride, 0.0F);
    std::fill_n(range_m.rbegin(), stride, 0.0F);
  }
  // From row -1 to `rows`.
  std::int32_t first_of_row(int row) const { return (row + 1) * stride + kMargin; }
};

// Turns the sums of a row into means.
void average_row(int row, WarpCanvas& canvas);

// Where the reference had returns, not warped: the car's own shadow stays.
struct ReturnsBefore {
  // For the cells of a row of the image, twice around the turn that it is turned by: columns of the sensor in
  // the reference; negative: none.
  std::span<const std::int32_t> columns;
  std::span<const float> range_m;  // of the reference's row in its own image
  int shift;                       // by which that is turned
};

// After the rows around it: makes a row of the image, holes filled.
void finish_row(const WarpCanvas& canvas, int row, const ReturnsBefore& before, ReferenceImage& image);

}  // namespace pointreel
