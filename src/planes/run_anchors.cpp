#include "planes/run_anchors.h"

#include <cmath>
#include <cstdlib>

namespace pointreel {
namespace {

struct Vector3 {
  double x, y, z;
};

Vector3 ray_of(const AngularGrid& grid, GridCell cell) {
  const double cos_e = grid.cos_elevation(cell.row);
  return {cos_e * grid.cos_azimuth(cell.column), cos_e * grid.sin_azimuth(cell.column),
          static_cast<double>(grid.sin_elevation(cell.row))};
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace

RunAnchors choose_anchors(const RangeImage& image, const TileLayout& layout, const PlaneRun& run) {
  const int row_begin = layout.first_row(run.tile_row), row_end = layout.end_row(run.tile_row);
  const int column_begin = layout.first_column(run.first_tile);
  const int column_end = layout.end_column(run.end_tile - 1, image.columns);

  GridCell left{-1, -1}, right{-1, -1};
  for (int column = column_begin; column < column_end; ++column) {
    for (int row = row_end - 1; row >= row_begin; --row) {
      if (!image.occupied(row, column)) continue;
      if (left.column < 0) left = {row, column};
      if (right.column != column) right = {row, column};  // the lowest cell of the last occupied column
    }
  }
  RunAnchors anchors;
  if (left.column < 0) return anchors;
  const auto in_grid = [&](GridCell c) { return GridCell{c.row + image.first_row, c.column}; };
  anchors.cells[0] = in_grid(left);
  anchors.count = 1;
  if (left.column == right.column) {
    // One column: take its highest cell as the second anchor; the third is missing as for any line.
    for (int row = row_begin; row < left.row; ++row) {
      if (!image.occupied(row, left.column)) continue;
      anchors.cells[1] = in_grid({row, left.column});
      anchors.count = 2;
      break;
    }
    return anchors;
  }
  anchors.cells[1] = in_grid(right);
  anchors.count = 2;

  // Farthest from the line left-right, in cells; among equals the one nearest to the middle.
  const int dc = right.column - left.column, dr = right.row - left.row;
  long best_area = 0;
  int best_off_middle = 0;
  for (int row = row_begin; row < row_end; ++row) {
    for (int column = column_begin; column < column_end; ++column) {
      if (!image.occupied(row, column)) continue;
      const long area = std::labs(static_cast<long>(dc) * (row - left.row) -
                                  static_cast<long>(dr) * (column - left.column));
      const int off_middle = std::abs(2 * column - left.column - right.column);
      if (area > best_area || (area == best_area && area > 0 && off_middle < best_off_middle)) {
        best_area = area;
        best_off_middle = off_middle;
        anchors.cells[2] = in_grid({row, column});
        anchors.count = 3;
      }
    }
  }
  return anchors;
}

Plane plane_from_anchors(const AngularGrid& grid, const RunAnchors& anchors,
                         const std::array<std::int32_t, 3>& levels, double step_m) {
  const Vector3 a = ray_of(grid, anchors.cells[0]);
  const double inverse_a = 1.0 / (levels[0] * step_m);
  if (anchors.count == 1) return {a.x * inverse_a, a.y * inverse_a, a.z * inverse_a};  // facing the sensor

  const Vector3 b = ray_of(grid, anchors.cells[1]);
  const double inverse_b = 1.0 / (levels[1] * step_m);
  // With cells on a line only, the plane of least |n|: no component across the two rays.
  const Vector3 c = anchors.count == 3 ? ray_of(grid, anchors.cells[2]) : cross(a, b);
  const double inverse_c = anchors.count == 3 ? 1.0 / (levels[2] * step_m) : 0.0;

  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double determinant = dot(a, bc);
  if (determinant == 0) return {a.x * inverse_a, a.y * inverse_a, a.z * inverse_a};
  const double wa = inverse_a / determinant, wb = inverse_b / determinant, wc = inverse_c / determinant;
  return {wa * bc.x + wb * ca.x + wc * ab.x, wa * bc.y + wb * ca.y + wc * ab.y,
          wa * bc.z + wb * ca.z + wc * ab.z};
}

std::int32_t nearest_level(double range_m, double step_m) {
  const double level = std::floor(range_m / step_m + 0.5);
  if (!(level > 1)) return 1;
  return level < kMaxLevel ? static_cast<std::int32_t>(level) : kMaxLevel;
}

}  // namespace pointreel
