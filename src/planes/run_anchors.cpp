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

// Lowest occupied cell of the first column that has one, walking from `from` by `step` up to `end`.
GridCell first_from_side(const RangeImage& image, int row_begin, int row_end, int from, int end, int step) {
  for (int column = from; column != end; column += step) {
    for (int row = row_end - 1; row >= row_begin; --row) {
      if (image.occupied(row, column)) return {row, column};
    }
  }
  return {-1, -1};
}

// The occupied cell of a row nearest to the middle of [left, right]; column -1 when there is none.
int nearest_to_middle(const RangeImage& image, int row, int left, int right) {
  const int middle = (left + right) / 2;
  for (int away = 0; middle - away >= left || middle + away <= right; ++away) {
    if (middle - away >= left && image.occupied(row, middle - away)) return middle - away;
    if (middle + away <= right && image.occupied(row, middle + away)) return middle + away;
  }
  return -1;
}

}  // namespace

RunAnchors choose_anchors(const RangeImage& image, const TileLayout& layout, const PlaneRun& run) {
  const int row_begin = layout.first_row(run.tile_row), row_end = layout.end_row(run.tile_row);
  const int column_begin = layout.first_column(run.first_tile);
  const int column_end = layout.end_column(run.end_tile - 1, image.columns);

  RunAnchors anchors;
  const GridCell left = first_from_side(image, row_begin, row_end, column_begin, column_end, 1);
  if (left.column < 0) return anchors;
  const GridCell right = first_from_side(image, row_begin, row_end, column_end - 1, column_begin - 1, -1);
  const auto add = [&](int row, int column) {
    anchors.cells[anchors.count++] = {row + image.first_row, column};
  };
  add(left.row, left.column);
  if (left.column == right.column) {
    // One column: its highest cell is the second anchor; the third is missing as for any line.
    for (int row = row_begin; row < left.row && anchors.count == 1; ++row) {
      if (image.occupied(row, left.column)) add(row, left.column);
    }
    return anchors;
  }
  add(right.row, right.column);

  const int dc = right.column - left.column, dr = right.row - left.row;
  int farthest = 0;
  GridCell third;
  for (int row = row_begin; row < row_end; ++row) {
    const int column = nearest_to_middle(image, row, left.column, right.column);
    if (column < 0) continue;
    const int off_line = std::abs(dc * (row - left.row) - dr * (column - left.column));
    if (off_line > farthest) {
      farthest = off_line;
      third = {row, column};
    }
  }
  if (farthest > 0) add(third.row, third.column);
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
