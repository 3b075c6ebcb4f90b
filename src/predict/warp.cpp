#include "predict/warp.h"

#include <algorithm>

#include "base/parallel.h"
#include "predict/coding_grid.h"
#include "predict/column_finder.h"
#include "predict/point_moving.h"
#include "predict/warp_canvas.h"
#include "predict/warped_points.h"

namespace pointreel {
namespace {

// Renders points into the cells from `first` to before `end`: before what is there, or as part of its mean
// when that is the same surface. Each cell has the points in the same sequence, whoever takes its part.
void render(const WarpedPoints& points, std::size_t first_point, std::size_t count, std::int32_t first,
            std::int32_t end, WarpCanvas& canvas) {
  constexpr float kSame = 0.03F;
  for (std::size_t point = first_point; point < first_point + count; ++point) {
    const std::int32_t at = points.nearest_cell[point];
    if (at < first || at >= end) continue;
    const auto cell = static_cast<std::size_t>(at);
    const float range_m = points.nearest_range_m[point];
    const float weight = points.nearest_weight[point];
    float& sum = canvas.range_m[cell];
    float& total = canvas.weight[cell];
    if (total > 0 && range_m * total >= (1 - kSame) * sum) {
      if (range_m * total > (1 + kSame) * sum) continue;  // behind
      sum += range_m * weight;
      total += weight;
      canvas.sides[cell] |= points.sides[point];
      continue;
    }
    sum = range_m * weight;
    total = weight;
    canvas.sides[cell] = points.sides[point];
  }
}

// Of the reference as it stood, by row and azimuth: the columns of the reference for those of the image.
// Twice around: rows are turned.
std::vector<std::int32_t> columns_before(const SweepGrid& reference, const SweepGrid& grid) {
  const ColumnFinder before(reference);
  std::vector<std::int32_t> columns;
  columns.reserve(2 * grid.column_count() + 8);
  for (const std::uint32_t tick : grid.column_tick) {
    const auto turn =
        static_cast<float>(static_cast<double>(tick % grid.ticks_per_turn) / grid.ticks_per_turn);
    columns.push_back(before.nearest(turn, static_cast<std::int32_t>(reference.column_count())));
  }
  columns.resize(2 * columns.size() + 8);  // SIMD code may begin at the last
  std::copy_n(columns.begin(), grid.column_count(),
              columns.begin() + static_cast<std::ptrdiff_t>(grid.column_count()));
  return columns;
}

}  // namespace

const ReferenceImage& warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                           const SweepMotion& sweep_motion, int threads, WarpMemory& memory) {
  const CodingGrid coding(model, grid), coding_before(model, reference.grid);
  const WarpSource source(model, reference.grid, coding_before);
  const WarpTarget target(model, grid, coding);
  const PointMotion motion(sweep_motion);
  const GridImage& before = reference.image;
  WarpedPoints& points = memory.points;
  WarpCanvas& canvas = memory.canvas;
  ReferenceImage& image = memory.image;
  points.lay_out(before.rows, before.columns);
  canvas.clear(target.rows, target.columns);
  image.rows = target.rows;
  image.columns = target.columns;
  image.range_m.resize(coding.rows() * coding.columns());
  image.hits.resize(coding.rows() * coding.columns());

  const auto rows_before = static_cast<std::size_t>(before.rows);
  parallel_for(rows_before, threads, [&](std::size_t row) {
    move_points(before, static_cast<int>(row), source, motion, target, points);
  });
  parallel_for(rows_before, threads, [&](std::size_t row) {
    find_surfaces(static_cast<int>(row), before.columns, target, canvas, points);
  });
  const int pieces = std::max(1, std::min(threads, target.rows));
  parallel_for(static_cast<std::size_t>(pieces), threads, [&](std::size_t piece) {
    const int first_row = target.rows * static_cast<int>(piece) / pieces;
    const int end_row = target.rows * (static_cast<int>(piece) + 1) / pieces;
    for (int row = 0; row < before.rows; ++row) {
      render(points, points.index(row, 0), static_cast<std::size_t>(before.columns),
             canvas.first_of_row(first_row), canvas.first_of_row(end_row), canvas);
    }
    for (int row = first_row; row < end_row; ++row) average_row(row, canvas);
  });
  const auto columns_in_reference = columns_before(reference.grid, grid);
  parallel_for(coding.rows(), threads, [&](std::size_t row) {
    const auto first = static_cast<std::ptrdiff_t>(coding.columns() - coding.shift(row));
    const ReturnsBefore returns{
        std::span(columns_in_reference).subspan(static_cast<std::size_t>(first)),
        std::span(before.range_m).subspan(row * coding_before.columns(), coding_before.columns()),
        static_cast<int>(coding_before.shift(row))};
    finish_row(canvas, static_cast<int>(row), returns, image);
  });
  return image;
}

}  // namespace pointreel
