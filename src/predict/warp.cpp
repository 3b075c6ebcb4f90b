#include "predict/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "base/trigonometry.h"
#include "predict/coding_grid.h"
#include "predict/column_finder.h"

namespace pointreel {
namespace {

constexpr float kNearestM = 0.05F;  // from the axis: nearer points have no direction
constexpr float kFarthestM = 1e5F;  // whatever a damaged pose says, numbers stay finite

struct Row {
  float slope, offset_m, azimuth_turns, side_turns_m, range_per_rho;
};

std::vector<Row> rows_of(const SensorModel& model) {
  std::vector<Row> rows;
  for (const RowModel& row : model.rows) {
    rows.push_back({static_cast<float>(row.slope), static_cast<float>(row.offset_m),
                    static_cast<float>(row.azimuth_rad / (2 * kPi)),
                    static_cast<float>(row.side_offset_m / (2 * kPi)),
                    static_cast<float>(std::sqrt(1 + row.slope * row.slope))});
  }
  return rows;
}

// Where the reference's points fall in the image, in cells, and how the surface leans there. One row and one
// column of empty points all around, so that neighbours need no borders.
struct WarpedPoints {
  std::size_t stride;
  std::vector<float> row, column;          // between cells
  std::vector<float> inverse_rho;          // 1 / distance from the axis: linear along a plane; 0: no point
  std::vector<float> range_m;              // of the reference; 0: no point
  std::vector<float> per_column, per_row;  // slope of inverse_rho
  std::vector<std::int32_t> sides;         // neighbours on the same surface: kRight and so on

  WarpedPoints(int rows, int columns)
      : stride(static_cast<std::size_t>(columns) + 2),
        row(stride * (static_cast<std::size_t>(rows) + 2)),
        column(row.size()),
        inverse_rho(row.size()),
        range_m(row.size()),
        per_column(row.size()),
        per_row(row.size()),
        sides(row.size()) {}
  std::size_t index(int r, int c) const {
    return static_cast<std::size_t>(r + 1) * stride + static_cast<std::size_t>(c + 1);
  }
};
constexpr std::int32_t kRight = 1, kLeft = 2, kBelow = 4, kAbove = 8;

// From one point to a neighbour on its surface.
struct Step {
  float rows, columns, u;
};
// 1 or 0, for SIMD code.
inline float same_surface(float range_m, float other_m) {
  const float same = std::fabs(other_m - range_m) <= 0.03F * range_m + 0.3F ? 1.0F : 0.0F;
  return other_m > 0 ? same : 0.0F;
}
// Across the seam of an image of `width` columns, if that is shorter.
inline float columns_between(float from, float to, float width) {
  float columns = to - from;
  columns -= columns > 0.5F * width ? width : 0.0F;
  columns += columns < -0.5F * width ? width : 0.0F;
  return columns;
}

class Warp {
 public:
  Warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
       const Pose& T_ref_cur)
      : model_(model),
        reference_(reference),
        rows_(rows_of(model)),
        coding_(model, grid),
        finder_(grid),
        points_(reference.rows, reference.columns),
        image_{static_cast<int>(coding_.rows()), static_cast<int>(coding_.columns()), {}, {}} {
    // The inverse: p_cur = R^T (p_ref - t).
    const Eigen::Matrix3d r = T_ref_cur.linear();
    const Eigen::Vector3d t = T_ref_cur.translation();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        rotation_[static_cast<std::size_t>(3 * i + j)] = static_cast<float>(r(j, i));
      translation_m_[static_cast<std::size_t>(i)] =
          static_cast<float>(-((r(0, i) * t(0) + r(1, i) * t(1)) + r(2, i) * t(2)));
    }
    for (std::size_t row = 0; row < rows_.size(); ++row)
      shift_.push_back(static_cast<float>(coding_.shift(row)));
  }

  ReferenceImage run(int threads) {
    const auto reference_rows = static_cast<std::size_t>(reference_.rows);
    parallel_for(reference_rows, threads, [&](std::size_t row) { move_row(static_cast<int>(row)); });
    parallel_for(reference_rows, threads, [&](std::size_t row) { find_slopes(static_cast<int>(row)); });
    const std::size_t cells =
        static_cast<std::size_t>(image_.rows) * static_cast<std::size_t>(image_.columns);
    image_.range_m.assign(cells, 0);
    image_.hits.assign(cells, 0);
    weight_.assign(cells, 0);
    find_previous_hits();
    // Every cell has the points in the same sequence, whoever takes its row.
    const int pieces = std::min(threads, image_.rows);
    parallel_for(static_cast<std::size_t>(pieces), threads, [&](std::size_t piece) {
      const int i = static_cast<int>(piece);
      render({image_.rows * i / pieces, image_.rows * (i + 1) / pieces});
    });
    return std::move(image_);
  }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(reference_.columns) +
           static_cast<std::size_t>(column);
  }

  // Of the reference as it stood, by row and azimuth.
  void find_previous_hits() {
    const ColumnFinder before(reference_.grid);
    const CodingGrid coding_before(model_, reference_.grid);
    std::vector<std::int32_t> column_before;
    for (std::size_t c = 0; c < coding_.columns(); ++c)
      column_before.push_back(before.nearest_to(finder_, c));
    for (std::size_t row = 0; row < coding_.rows(); ++row) {
      CodingGrid::Finder cell(coding_), cell_before(coding_before);
      for (std::size_t c = 0; c < coding_.columns(); ++c) {
        if (column_before[c] < 0) continue;
        const auto there = row * coding_before.columns() + static_cast<std::size_t>(column_before[c]);
        if (reference_.range_m[cell_before(there)] > 0)
          image_.hits[cell(row * coding_.columns() + c)] = kPreviousHit;
      }
    }
  }

  // Rows of the image.
  struct Rows {
    int first, end;
    bool hold(int row) const { return row >= first && row < end; }
  };
  void render(const Rows& rows) {
    for_each_point(rows, [&](std::size_t point) { render_nearest(point, rows); });
    for_each_point(rows, [&](std::size_t point) { render_holes(point, rows); });
    for (std::size_t cell = image_.index(rows.first, 0); cell < image_.index(rows.end, 0); ++cell) {
      image_.range_m[cell] = weight_[cell] > 0 ? image_.range_m[cell] / weight_[cell] : 0.0F;
    }
  }
  // Those that can touch the rows.
  template <class Render>
  void for_each_point(const Rows& rows, const Render& render) {
    const auto least = static_cast<float>(rows.first - 1), most = static_cast<float>(rows.end);
    for (int row = 0; row < reference_.rows; ++row) {
      const std::size_t first = points_.index(row, 0);
      for (std::size_t point = first; point < first + static_cast<std::size_t>(reference_.columns); ++point) {
        if (points_.range_m[point] > 0 && points_.row[point] >= least && points_.row[point] <= most)
          render(point);
      }
    }
  }

  void move_row(int row) {
    const auto columns = static_cast<std::size_t>(reference_.columns);
    std::vector<float> z_m(columns), rho_m(columns), azimuth_rad(columns);
    const std::size_t first = index(row, 0);
    const float* x = &reference_.x_m[first];
    const float* y = &reference_.y_m[first];
    const float* z = &reference_.z_m[first];
    const auto& r = rotation_;
    const auto& t = translation_m_;
    for (std::size_t c = 0; c < columns; ++c) {
      const float px = (r[0] * x[c] + r[1] * y[c]) + (r[2] * z[c] + t[0]);
      const float py = (r[3] * x[c] + r[4] * y[c]) + (r[5] * z[c] + t[1]);
      z_m[c] = (r[6] * x[c] + r[7] * y[c]) + (r[8] * z[c] + t[2]);
      rho_m[c] = std::sqrt(px * px + py * py);
      azimuth_rad[c] = fast_atan2(py, px);
    }
    int last_row = row;
    const std::size_t first_point = points_.index(row, 0);
    for (std::size_t c = 0; c < columns; ++c) {
      if (!(reference_.range_m[first + c] > 0) || !(rho_m[c] > kNearestM && rho_m[c] < kFarthestM) ||
          !(std::fabs(z_m[c]) < kFarthestM))
        continue;
      last_row = nearest_row(z_m[c], rho_m[c], last_row);
      if (place(first_point + c, last_row, z_m[c], rho_m[c], azimuth_rad[c]))
        points_.range_m[first_point + c] = reference_.range_m[first + c];
    }
    // The reference goes around.
    const auto wrap = [&](std::size_t to, std::size_t from) {
      for (auto* values : {&points_.row, &points_.column, &points_.inverse_rho, &points_.range_m})
        (*values)[to] = (*values)[from];
    };
    wrap(first_point - 1, first_point + columns - 1);
    wrap(first_point + columns, first_point);
  }

  float height_above(int row, float z_m, float rho_m) const {
    const Row& at = rows_[static_cast<std::size_t>(row)];
    return z_m - (at.slope * rho_m + at.offset_m);
  }
  int nearest_row(float z_m, float rho_m, int row) const {
    float distance = std::fabs(height_above(row, z_m, rho_m));
    for (const int step : {-1, 1}) {
      for (;;) {
        const int next = row + step;
        if (next < 0 || next >= image_.rows) break;
        const float there = std::fabs(height_above(next, z_m, rho_m));
        if (!(there < distance)) break;
        row = next;
        distance = there;
      }
    }
    return row;
  }

  // False when no row or no column looks there.
  bool place(std::size_t point, int row, float z_m, float rho_m, float azimuth_rad) {
    constexpr float kMostBeyond = 0.6F;  // rows, past the first and the last
    const float above = height_above(row, z_m, rho_m);
    const int step = above > 0 ? -1 : 1;
    const int other = row + step;
    const bool inside = other >= 0 && other < image_.rows;
    const int from = inside ? row : row - step, to = inside ? other : row;  // two rows that tell the spacing
    float beside = 0;                                                       // rows from `row` towards `other`
    if (from >= 0 && from < image_.rows && from != to) {
      const float spacing = std::fabs(height_above(to, z_m, rho_m) - height_above(from, z_m, rho_m));
      beside = spacing > 1e-4F ? std::fabs(above) / spacing : 0;
    }
    if (!inside && beside > kMostBeyond) return false;
    beside = beside < 1 ? beside : 1;
    const Row& at = rows_[static_cast<std::size_t>(row)];
    float turn = azimuth_rad * static_cast<float>(1 / (2 * kPi)) - at.azimuth_turns - at.side_turns_m / rho_m;
    turn -= static_cast<float>(static_cast<std::int32_t>(turn));
    turn += turn < 0 ? 1.0F : 0.0F;
    const float column = finder_.position(turn);
    if (column < 0) return false;
    points_.row[point] = static_cast<float>(row) + static_cast<float>(step) * beside;
    points_.column[point] = column + shift_[static_cast<std::size_t>(row)];
    points_.inverse_rho[point] = 1 / rho_m;
    return true;
  }

  // Slopes of a row's points from their neighbours on the same surface; without branches, for SIMD code.
  void find_slopes(int row) {
    const std::size_t first = points_.index(row, 0);
    const auto columns = static_cast<std::ptrdiff_t>(reference_.columns);
    const auto stride = static_cast<std::ptrdiff_t>(points_.stride);
    const auto width = static_cast<float>(image_.columns);
    const float* r = &points_.row[first];
    const float* c = &points_.column[first];
    const float* u = &points_.inverse_rho[first];
    const float* range_m = &points_.range_m[first];
    float* __restrict per_column = &points_.per_column[first];
    float* __restrict per_row = &points_.per_row[first];
    std::int32_t* __restrict sides = &points_.sides[first];
    for (std::ptrdiff_t i = 0; i < columns; ++i) {
      const float right = same_surface(range_m[i], range_m[i + 1]),
                  left = same_surface(range_m[i], range_m[i - 1]);
      const float below = same_surface(range_m[i], range_m[i + stride]);
      const float above = same_surface(range_m[i], range_m[i - stride]);
      const Step to_right = {right * (r[i + 1] - r[i]), right * columns_between(c[i], c[i + 1], width),
                             right * (u[i + 1] - u[i])};
      const Step to_left = {left * (r[i - 1] - r[i]), left * columns_between(c[i], c[i - 1], width),
                            left * (u[i - 1] - u[i])};
      const Step down = {below * (r[i + stride] - r[i]), below * columns_between(c[i], c[i + stride], width),
                         below * (u[i + stride] - u[i])};
      const Step up = {above * (r[i - stride] - r[i]), above * columns_between(c[i], c[i - stride], width),
                       above * (u[i - stride] - u[i])};
      const Step beside = {to_right.rows - to_left.rows, to_right.columns - to_left.columns,
                           to_right.u - to_left.u};
      const Step over = {down.rows - up.rows, down.columns - up.columns, down.u - up.u};
      const float determinant = beside.columns * over.rows - beside.rows * over.columns;
      const float squared = determinant * determinant, width2 = beside.columns * beside.columns,
                  height2 = over.rows * over.rows;
      constexpr float kLeastDeterminant2 = 0.01F, kLeastStep2 = 0.04F;
      const float per_determinant = 1 / (squared > kLeastDeterminant2 ? determinant : 1.0F);
      const float along_row = beside.u / (width2 > kLeastStep2 ? beside.columns : 1.0F);
      const float along_column = over.u / (height2 > kLeastStep2 ? over.rows : 1.0F);
      const float only_row = width2 > kLeastStep2 ? along_row : 0.0F;
      const float if_no_row = height2 > kLeastStep2 ? along_column : 0.0F;
      const float only_column = width2 > kLeastStep2 ? 0.0F : if_no_row;
      const float plane_column = (beside.u * over.rows - beside.rows * over.u) * per_determinant;
      const float plane_row = (beside.columns * over.u - beside.u * over.columns) * per_determinant;
      per_column[i] = squared > kLeastDeterminant2 ? plane_column : only_row;
      per_row[i] = squared > kLeastDeterminant2 ? plane_row : only_column;
      sides[i] = static_cast<std::int32_t>(right * kRight + left * kLeft + below * kBelow + above * kAbove);
    }
  }

  // A point's place between four cells.
  struct Place {
    int row, column;              // of the upper left one
    float row_part, column_part;  // from there, 0 to 1
  };
  Place place_of(std::size_t point) const {
    const float at_row = points_.row[point], at_column = points_.column[point];
    const auto row = static_cast<std::int32_t>(at_row + 1) - 1;  // rounds down from -1 on
    const auto column = static_cast<std::int32_t>(at_column + 1) - 1;
    return {row, column, at_row - static_cast<float>(row), at_column - static_cast<float>(column)};
  }
  // Where the ray of a cell that is so far off the point meets its surface.
  float range_beside(std::size_t point, int row, float rows_off, float columns_off) const {
    const float u = points_.inverse_rho[point];
    const float moved = u + (points_.per_row[point] * rows_off + points_.per_column[point] * columns_off);
    const float least = 0.8F * u, most = 1.25F * u;
    const float limited = moved < least ? least : moved > most ? most : moved;
    return rows_[static_cast<std::size_t>(row)].range_per_rho / limited;
  }
  std::size_t cell_at(int row, int column) const {
    // A turned row, and a last column of its own: less than two widths away.
    if (column < 0) column += image_.columns;
    if (column >= image_.columns) column -= image_.columns;
    if (column >= image_.columns) column -= image_.columns;
    return image_.index(row, column);
  }

  // Into the nearest cell: before what is there, or as part of its mean when that is the same surface.
  void render_nearest(std::size_t point, const Rows& rows) {
    const Place at = place_of(point);
    const int down = at.row_part > 0.5F ? 1 : 0, right = at.column_part > 0.5F ? 1 : 0;
    const int row = at.row + down;
    if (!rows.hold(row)) return;
    const float rows_off = static_cast<float>(down) - at.row_part;
    const float columns_off = static_cast<float>(right) - at.column_part;
    const float range_m = range_beside(point, row, rows_off, columns_off);
    const float weight = (1.02F - std::fabs(rows_off)) * (1.02F - std::fabs(columns_off));
    const std::size_t cell = cell_at(row, at.column + right);
    float& sum = image_.range_m[cell];
    float& total = weight_[cell];
    constexpr float kSame = 0.03F;
    if ((image_.hits[cell] & kWarpedHit) != 0) {
      if (range_m * total > (1 + kSame) * sum) return;  // behind
      if (range_m * total >= (1 - kSame) * sum) {
        sum += range_m * weight;
        total += weight;
        return;
      }
    }
    image_.hits[cell] |= kWarpedHit;
    sum = range_m * weight;
    total = weight;
  }

  // Into the other three, where its surface goes on and no point is nearest.
  void render_holes(std::size_t point, const Rows& rows) {
    const std::int32_t sides = points_.sides[point];
    const Place at = place_of(point);
    for (int down = 0; down < 2; ++down) {
      const int row = at.row + down;
      const bool near_row = (at.row_part > 0.5F) == (down == 1);
      if (!rows.hold(row) || !(near_row || (sides & (down == 1 ? kBelow : kAbove)) != 0)) continue;
      for (int right = 0; right < 2; ++right) {
        const bool near_column = (at.column_part > 0.5F) == (right == 1);
        if ((near_row && near_column) || !(near_column || (sides & (right == 1 ? kRight : kLeft)) != 0))
          continue;
        const std::size_t cell = cell_at(row, at.column + right);
        if ((image_.hits[cell] & kWarpedHit) != 0) continue;
        const float range_m = range_beside(point, row, static_cast<float>(down) - at.row_part,
                                           static_cast<float>(right) - at.column_part);
        if ((image_.hits[cell] & kWarpedFilled) != 0 && !(range_m < image_.range_m[cell])) continue;
        image_.hits[cell] |= kWarpedFilled;
        image_.range_m[cell] = range_m;
        weight_[cell] = 1;
      }
    }
  }

  const SensorModel& model_;
  const ReferenceSweep& reference_;
  std::vector<Row> rows_;
  CodingGrid coding_;
  ColumnFinder finder_;
  std::vector<float> shift_;  // whole columns by which a row is turned in the image
  WarpedPoints points_;
  ReferenceImage image_;  // ranges: sums until the end
  std::vector<float> weight_;
  std::array<float, 9> rotation_;
  std::array<float, 3> translation_m_;
};

}  // namespace

ReferenceImage warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                    const Pose& T_ref_cur, int threads) {
  return Warp(model, grid, reference, T_ref_cur).run(threads);
}

}  // namespace pointreel
