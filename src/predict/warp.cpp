#include "predict/warp.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "predict/coding_grid.h"
#include "predict/column_finder.h"
#include "predict/point_moving.h"
#include "predict/warped_points.h"

namespace pointreel {
namespace {

// Renders points into a part of the rows. Each cell has the points in the same sequence, whoever takes its
// row.
class Renderer {
 public:
  Renderer(const WarpedPoints& points, const WarpTarget& target, int first_row, int end_row,
           WarpCanvas& canvas)
      : points_(points),
        target_(target),
        canvas_(canvas),
        first_(canvas.first_of_row(first_row)),
        end_(canvas.first_of_row(end_row)) {}

  // Into the nearest cell: before what is there, or as part of its mean when that is the same surface.
  void render_nearest(std::size_t point) {
    const std::int32_t at = points_.nearest_cell[point];
    if (!holds(at)) return;
    const auto cell = static_cast<std::size_t>(at);
    const float range_m = points_.nearest_range_m[point];
    const float weight = points_.nearest_weight[point];
    float& sum = canvas_.range_m[cell];
    float& total = canvas_.weight[cell];
    constexpr float kSame = 0.03F;
    if (total > 0 && range_m * total >= (1 - kSame) * sum) {
      if (range_m * total > (1 + kSame) * sum) return;  // behind
      sum += range_m * weight;
      total += weight;
      return;
    }
    canvas_.hits[cell] = kWarpedHit;
    sum = range_m * weight;
    total = weight;
  }

  // Into the other three around the point, where its surface goes on and no point is nearest.
  void render_holes(std::size_t point) {
    const std::int32_t upper_left = points_.upper_left[point], below = canvas_.columns;
    if (upper_left < first_ - below || upper_left >= end_) return;
    const std::int32_t sides = points_.sides[point];
    const std::int32_t right_of_it = (sides & kAtSeam) != 0 ? 1 - canvas_.columns : 1;
    const std::array<std::int32_t, 4> cells = {upper_left, upper_left + right_of_it, upper_left + below,
                                               upper_left + below + right_of_it};
    if (cells[0] >= first_ && cells[2] < end_ && all_hit(cells)) return;
    const int row = static_cast<std::int32_t>(points_.row[point] + 1) - 1;
    const int column = static_cast<std::int32_t>(points_.column[point] + 1) - 1;
    const float row_part = points_.row[point] - static_cast<float>(row);
    const float column_part = points_.column[point] - static_cast<float>(column);
    for (int i = 0; i < 4; ++i) {
      const std::int32_t at = cells[static_cast<std::size_t>(i)];
      const auto cell = static_cast<std::size_t>(at);
      if (!holds(at) || (canvas_.hits[cell] & kWarpedHit) != 0) continue;
      const int down = i / 2, right = i % 2;
      const bool near_row = (row_part > 0.5F) == (down == 1);
      const bool near_column = (column_part > 0.5F) == (right == 1);
      if (!near_row && (sides & (down == 1 ? kBelow : kAbove)) == 0) continue;
      if (!near_column && (sides & (right == 1 ? kRight : kLeft)) == 0) continue;
      const float range_m = range_beside(point, row + down, static_cast<float>(down) - row_part,
                                         static_cast<float>(right) - column_part);
      if (canvas_.hits[cell] != 0 && !(range_m < canvas_.range_m[cell])) continue;
      canvas_.hits[cell] = kWarpedFilled;
      canvas_.range_m[cell] = range_m;
      canvas_.weight[cell] = 1;
    }
  }

 private:
  bool holds(std::int32_t cell) const { return cell >= first_ && cell < end_; }
  bool all_hit(const std::array<std::int32_t, 4>& cells) const {
    std::uint8_t hits = kWarpedHit;
    for (const std::int32_t cell : cells) hits &= canvas_.hits[static_cast<std::size_t>(cell)];
    return hits != 0;
  }
  // Where the ray of a cell that is so far off the point meets its surface.
  float range_beside(std::size_t point, int row, float rows_off, float columns_off) const {
    const float u = points_.inverse_rho[point];
    const float moved = u + (points_.per_row[point] * rows_off + points_.per_column[point] * columns_off);
    const float limited = std::min(std::max(moved, 0.8F * u), 1.25F * u);
    return target_.range_per_rho[static_cast<std::size_t>(row)] / limited;
  }

  const WarpedPoints& points_;
  const WarpTarget& target_;
  WarpCanvas& canvas_;
  std::int32_t first_, end_;
};

// Of the reference as it stood, by row and azimuth: the columns of the reference for those of the image.
std::vector<std::int32_t> columns_before(const SweepGrid& reference, const WarpTarget& target) {
  const ColumnFinder before(reference);
  std::vector<std::int32_t> columns;
  for (int c = 0; c < target.columns; ++c)
    columns.push_back(before.nearest_to(target.finder, static_cast<std::size_t>(c)));
  return columns;
}

}  // namespace

const ReferenceImage& warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                           const Pose& T_ref_cur, int threads, WarpMemory& memory) {
  const CodingGrid coding(model, grid), coding_before(model, reference.grid);
  const WarpTarget target(model, grid, coding);
  const PointMotion motion(T_ref_cur);
  WarpedPoints& points = memory.points;
  WarpCanvas& canvas = memory.canvas;
  ReferenceImage& image = memory.image;
  points.lay_out(reference.rows, reference.columns);
  canvas.clear(target.rows, target.columns);
  const auto reference_rows = static_cast<std::size_t>(reference.rows);
  parallel_for(reference_rows, threads, [&](std::size_t row) {
    move_points(reference, static_cast<int>(row), motion, target, points);
  });
  parallel_for(reference_rows, threads, [&](std::size_t row) {
    find_surfaces(static_cast<int>(row), reference.columns, target, points);
  });

  const auto image_columns = static_cast<std::size_t>(target.columns);
  image.rows = target.rows;
  image.columns = target.columns;
  image.range_m.resize(coding.rows() * image_columns);
  image.hits.resize(coding.rows() * image_columns);
  const auto columns_in_reference = columns_before(reference.grid, target);
  const int pieces = std::max(1, std::min(threads, target.rows));
  parallel_for(static_cast<std::size_t>(pieces), threads, [&](std::size_t piece) {
    const int first_row = target.rows * static_cast<int>(piece) / pieces;
    const int end_row = target.rows * (static_cast<int>(piece) + 1) / pieces;
    Renderer renderer(points, target, first_row, end_row, canvas);
    const auto for_each_point = [&](const auto& render) {
      for (int row = 0; row < reference.rows; ++row) {
        const std::size_t first = points.index(row, 0);
        for (std::size_t i = 0; i < static_cast<std::size_t>(reference.columns); ++i) render(first + i);
      }
    };
    for_each_point([&](std::size_t point) { renderer.render_nearest(point); });
    for_each_point([&](std::size_t point) { renderer.render_holes(point); });
    for (int row = first_row; row < end_row; ++row) {
      const auto r = static_cast<std::size_t>(row);
      const auto from = static_cast<std::size_t>(canvas.first_of_row(row));
      const std::size_t to = image.index(row, 0);
      for (std::size_t c = 0; c < image_columns; ++c) {
        const float weight = canvas.weight[from + c];
        image.range_m[to + c] = weight > 0 ? canvas.range_m[from + c] / weight : 0.0F;
        image.hits[to + c] = canvas.hits[from + c];
      }
      CodingGrid::Finder cell(coding), cell_before(coding_before);
      for (std::size_t c = 0; c < image_columns; ++c) {
        if (columns_in_reference[c] < 0) continue;
        const auto there = r * coding_before.columns() + static_cast<std::size_t>(columns_in_reference[c]);
        if (reference.range_m[cell_before(there)] > 0)
          image.hits[cell(r * image_columns + c)] |= kPreviousHit;
      }
    }
  });
  return image;
}

}  // namespace pointreel
