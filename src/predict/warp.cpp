#include "predict/warp.h"

#include <array>
#include <cmath>

#include "base/parallel.h"
#include "base/trigonometry.h"
#include "predict/coding_grid.h"
#include "predict/column_finder.h"

namespace pointreel {
namespace {

constexpr float kNearestM = 0.05F;  // from the axis: nearer points have no direction

struct Row {
  float slope, offset_m, azimuth_turns, side_turns_m, range_per_rho;
};

std::vector<Row> rows_of(const SensorModel& model) {
  std::vector<Row> rows;
  for (const RowModel& row : model.rows) {
    rows.push_back({static_cast<float>(row.slope), static_cast<float>(row.offset_m),
                    static_cast<float>(row.azimuth_rad / (2 * kPi)), static_cast<float>(row.side_offset_m / (2 * kPi)),
                    static_cast<float>(std::sqrt(1 + row.slope * row.slope))});
  }
  return rows;
}

// Where the reference's points fall in the image, in cells; NaN-free, row < 0: nowhere.
struct WarpedPoints {
  std::vector<float> row, column;       // between cells
  std::vector<float> inverse_rho;       // 1 / distance from the axis: linear along a plane
  std::vector<std::int32_t> nearest_row;

  explicit WarpedPoints(std::size_t count)
      : row(count, -1), column(count), inverse_rho(count), nearest_row(count, -1) {}
};

class Warp {
 public:
  Warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference, const Pose& T_ref_cur)
      : reference_(reference),
        rows_(rows_of(model)),
        coding_(model, grid),
        finder_(grid),
        points_(reference.range_m.size()),
        image_{static_cast<int>(coding_.rows()), static_cast<int>(coding_.columns()), {}, {}} {
    // The inverse: p_cur = R^T (p_ref - t).
    const Eigen::Matrix3d r = T_ref_cur.linear();
    const Eigen::Vector3d t = T_ref_cur.translation();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rotation_[static_cast<std::size_t>(3 * i + j)] = static_cast<float>(r(j, i));
      translation_m_[static_cast<std::size_t>(i)] =
          static_cast<float>(-((r(0, i) * t(0) + r(1, i) * t(1)) + r(2, i) * t(2)));
    }
    for (std::size_t row = 0; row < rows_.size(); ++row) shift_.push_back(static_cast<float>(coding_.shift(row)));
  }

  ReferenceImage run(int threads) {
    parallel_for(static_cast<std::size_t>(reference_.rows), threads, [&](std::size_t row) { move_row(static_cast<int>(row)); });
    const std::size_t cells = static_cast<std::size_t>(image_.rows) * static_cast<std::size_t>(image_.columns);
    image_.range_m.assign(cells, 0);
    image_.hits.assign(cells, 0);
    weight_.assign(cells, 0);
    for (int row = 0; row < reference_.rows; ++row) {
      for (int column = 0; column < reference_.columns; ++column) render(row, column);
    }
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (weight_[cell] > 0) image_.range_m[cell] = image_.range_m[cell] / weight_[cell];
    }
    return std::move(image_);
  }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(reference_.columns) +
           static_cast<std::size_t>(column);
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
    for (std::size_t c = 0; c < columns; ++c) {
      if (!(reference_.range_m[first + c] > 0) || !(rho_m[c] > kNearestM)) continue;
      last_row = nearest_row(z_m[c], rho_m[c], last_row);
      place(first + c, last_row, z_m[c], rho_m[c], azimuth_rad[c]);
    }
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

  void place(std::size_t point, int row, float z_m, float rho_m, float azimuth_rad) {
    constexpr float kMostBeyond = 0.6F;  // rows, past the first and the last
    const float above = height_above(row, z_m, rho_m);
    const int step = above > 0 ? -1 : 1;
    const int other = row + step;
    const bool inside = other >= 0 && other < image_.rows;
    const int from = inside ? row : row - step, to = inside ? other : row;  // two rows that tell the spacing
    float beside = 0;  // rows from `row` towards `other`
    if (from >= 0 && from < image_.rows && from != to) {
      const float spacing = std::fabs(height_above(to, z_m, rho_m) - height_above(from, z_m, rho_m));
      beside = spacing > 1e-4F ? std::fabs(above) / spacing : 0;
    }
    if (!inside && beside > kMostBeyond) return;
    beside = beside < 1 ? beside : 1;
    const Row& at = rows_[static_cast<std::size_t>(row)];
    float turn = azimuth_rad * static_cast<float>(1 / (2 * kPi)) - at.azimuth_turns - at.side_turns_m / rho_m;
    turn -= static_cast<float>(static_cast<std::int32_t>(turn));
    turn += turn < 0 ? 1.0F : 0.0F;
    points_.row[point] = static_cast<float>(row) + static_cast<float>(step) * beside;
    points_.column[point] = finder_.position(turn) + shift_[static_cast<std::size_t>(row)];
    points_.inverse_rho[point] = 1 / rho_m;
    points_.nearest_row[point] = row;
  }

  bool same_surface(std::size_t a, std::size_t b) const {
    if (points_.nearest_row[b] < 0) return false;
    const float range_m = reference_.range_m[a];
    return std::fabs(reference_.range_m[b] - range_m) <= 0.03F * range_m + 0.3F;
  }
  // Difference of image columns, across the seam.
  float columns_between(float from, float to) const {
    const auto columns = static_cast<float>(image_.columns);
    float d = to - from;
    if (d > 0.5F * columns) d -= columns;
    if (d < -0.5F * columns) d += columns;
    return d;
  }

  // Into the four cells around a point.
  void render(int row, int column) {
    const std::size_t point = index(row, column);
    const int near_row = points_.nearest_row[point];
    if (near_row < 0) return;
    const float at_row = points_.row[point], at_column = points_.column[point];
    const float u = points_.inverse_rho[point];
    // Neighbours on the same surface, which it leans towards.
    struct Neighbour {
      float rows = 0, columns = 0, u = 0;
      bool known = false;
    };
    const auto neighbour = [&](int r, int c) {
      c = c < 0 ? c + reference_.columns : c >= reference_.columns ? c - reference_.columns : c;
      if (r < 0 || r >= reference_.rows) return Neighbour{};
      const std::size_t other = index(r, c);
      if (!same_surface(point, other)) return Neighbour{};
      return Neighbour{points_.row[other] - at_row, columns_between(at_column, points_.column[other]),
                       points_.inverse_rho[other] - u, true};
    };
    const Neighbour right = neighbour(row, column + 1), left = neighbour(row, column - 1);
    const Neighbour below = neighbour(row + 1, column), above = neighbour(row - 1, column);
    const Neighbour beside = right.known && left.known
                                 ? Neighbour{right.rows - left.rows, right.columns - left.columns, right.u - left.u, true}
                                 : (right.known ? right : left);
    const Neighbour over = below.known && above.known
                               ? Neighbour{below.rows - above.rows, below.columns - above.columns, below.u - above.u, true}
                               : (below.known ? below : above);
    float per_column = 0, per_row = 0;  // of u
    const float determinant = beside.columns * over.rows - beside.rows * over.columns;
    if (beside.known && over.known && determinant * determinant > 0.01F) {
      per_column = (beside.u * over.rows - beside.rows * over.u) / determinant;
      per_row = (beside.columns * over.u - beside.u * over.columns) / determinant;
    } else if (beside.known && beside.columns * beside.columns > 0.04F) {
      per_column = beside.u / beside.columns;
    } else if (over.known && over.rows * over.rows > 0.04F) {
      per_row = over.u / over.rows;
    }

    const auto first_column = static_cast<std::int32_t>(at_column + 1) - 1;  // rounds down from -1 on
    const int other_row = at_row > static_cast<float>(near_row) ? near_row + 1 : near_row - 1;
    const float right_part = at_column - static_cast<float>(first_column);
    const bool nearer_right = right_part > 0.5F;
    for (const int r : {near_row, other_row}) {
      if (r < 0 || r >= image_.rows) continue;
      const float rows_off = static_cast<float>(r) - at_row;
      if (r == other_row && !(other_row > near_row ? below : above).known) continue;
      for (const int side : {0, 1}) {
        const bool nearest = (side == 1) == nearer_right;
        if (!nearest && !(side == 1 ? right : left).known) continue;
        const float columns_off = static_cast<float>(first_column + side) - at_column;
        const float moved = u + (per_column * columns_off + per_row * rows_off);
        const float limited = moved < 0.8F * u ? 0.8F * u : moved > 1.25F * u ? 1.25F * u : moved;
        const float weight = (1.02F - std::fabs(columns_off)) * (1.02F - std::fabs(rows_off));
        put(r, first_column + side, rows_[static_cast<std::size_t>(r)].range_per_rho / limited, weight,
            nearest && r == near_row);
      }
    }
  }

  void put(int row, int column, float range_m, float weight, bool nearest) {
    while (column < 0) column += image_.columns;
    while (column >= image_.columns) column -= image_.columns;
    const std::size_t cell = image_.index(row, column);
    float& sum = image_.range_m[cell];
    float& total = weight_[cell];
    std::uint8_t& hits = image_.hits[cell];
    constexpr float kSame = 0.03F;
    if (total > 0 && range_m * total > (1 + kSame) * sum) return;  // behind
    if (total > 0 && range_m * total < (1 - kSame) * sum) {
      sum = 0;
      total = 0;
      hits = 0;
    }
    sum += range_m * weight;
    total += weight;
    hits = static_cast<std::uint8_t>(nearest || hits == kWarpedHit ? kWarpedHit : kWarpedFilled);
  }

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
