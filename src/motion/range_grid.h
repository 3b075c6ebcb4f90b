// RangeGrid: a sweep on its sensor's grid as registration sees it, and GridRays: its cells as points, its
// directions as cells.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/trigonometry.h"

namespace pointreel {

// One laser: a point at horizontal distance rho has z = slope * rho + offset_m and lies at
// azimuth = column azimuth + azimuth_rad + atan2(side_offset_m, rho).
struct GridRow {
  double slope = 0;
  double offset_m = 0;
  double azimuth_rad = 0;
  double side_offset_m = 0;
};

// Views of arrays that someone else holds.
struct RangeGrid {
  std::span<const GridRow> rows;               // top to bottom
  std::span<const double> column_azimuth_rad;  // in the order in which they follow each other around
  std::span<const float>
      range_m;  // rows x columns, row-major, along the ray from (0, 0, offset); 0: no return
};

class GridRays {
 public:
  // Without rows when the grid's arrays do not fit each other.
  explicit GridRays(const RangeGrid& grid);

  int row_count() const { return static_cast<int>(rows_.size()); }
  int column_count() const { return static_cast<int>(columns_.size()); }
  float range_m(int row, int column) const { return range_m_[index(row, column)]; }

  // Meaningless where there is no return.
  Eigen::Vector3f point_m(int row, int column) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    const Column& c = columns_[static_cast<std::size_t>(column)];
    const float rho_m = range_m(row, column) * r.cos_elevation;
    const float cosine = c.cos * r.cos_azimuth - c.sin * r.sin_azimuth;
    const float sine = c.sin * r.cos_azimuth + c.cos * r.sin_azimuth;
    return {rho_m * cosine - r.side_offset_m * sine, rho_m * sine + r.side_offset_m * cosine,
            r.slope * rho_m + r.offset_m};
  }

  // Column of `row` that looks where `column` of row `from` does, far away.
  int same_direction(int column, int from, int row) const {
    return wrapped(column + rows_[static_cast<std::size_t>(from)].turned_by -
                   rows_[static_cast<std::size_t>(row)].turned_by);
  }
  // Of a column less than a turn outside.
  int wrapped(int column) const {
    const int count = column_count();
    return column < 0 ? column + count : column >= count ? column - count : column;
  }

  struct Cell {
    int row = -1, column = 0;
  };
  // Of the cells that look towards a point or just beside it, the one whose return is as far away as the
  // point, or most nearly so; negative row: none has a return.
  Cell return_near(const Eigen::Vector3f& p_m) const {
    const float rho_m = std::sqrt(p_m.x() * p_m.x() + p_m.y() * p_m.y());
    const int middle = row_towards(rho_m, p_m.z());
    if (middle < 0) return {};
    const Row& r = rows_[static_cast<std::size_t>(middle)];
    const float azimuth_rad = fast_atan2(p_m.y(), p_m.x()) - r.azimuth_rad - r.side_offset_m / rho_m;
    const auto bin = static_cast<std::uint32_t>(std::lrint(azimuth_rad * bins_per_rad_));
    const int column = column_of_bin_[bin & (static_cast<std::uint32_t>(column_of_bin_.size()) - 1)];
    Cell best;
    float best_away_m = std::numeric_limits<float>::infinity();
    const int last = std::min(middle + 1, row_count() - 1);
    for (int row = std::max(middle - 1, 0); row <= last; ++row) {
      const float cos_elevation = rows_[static_cast<std::size_t>(row)].cos_elevation;
      const int same = same_direction(column, middle, row);
      for (int beside = -1; beside <= 1; ++beside) {
        const int c = wrapped(same + beside);
        const float range = range_m(row, c);
        const float distance_m = std::fabs(range * cos_elevation - rho_m);
        if (!(range > 0) || !(distance_m < best_away_m)) continue;
        best = {row, c};
        best_away_m = distance_m;
      }
    }
    return best;
  }

 private:
  struct Row {
    float slope, offset_m, azimuth_rad, side_offset_m, cos_elevation, cos_azimuth, sin_azimuth;
    int turned_by;  // whole columns by which the row is ahead of the columns' azimuth, within a turn
  };
  struct Column {
    float cos, sin;
  };

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * columns_.size() + static_cast<std::size_t>(column);
  }
  int row_towards(float rho_m, float z_m) const {
    if (rows_.empty() || !(rho_m > kNearestM)) return -1;
    const auto last = static_cast<float>(row_of_bin_.size() - 1);
    const float bin = ((z_m - mean_offset_m_) / rho_m - lowest_slope_) * bins_per_slope_;
    if (!(bin > -kSlack && bin < last + kSlack)) return -1;
    int row = row_of_bin_[static_cast<std::size_t>(bin < 0 ? 0 : bin > last ? last : bin)];
    // Offsets differ between rows, which matters near the sensor.
    float away = height_above(row, rho_m, z_m);
    const int step = away > 0 ? -1 : 1;
    for (int next = row + step; next >= 0 && next < row_count(); next += step) {
      const float next_away = height_above(next, rho_m, z_m);
      if (std::fabs(next_away) >= std::fabs(away)) break;
      row = next;
      away = next_away;
    }
    return row;
  }
  float height_above(int row, float rho_m, float z_m) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    return z_m - r.offset_m - r.slope * rho_m;
  }

  static constexpr float kNearestM = 0.1F;
  static constexpr float kSlack = 4;  // bins beyond the outermost rows

  std::vector<Row> rows_;
  std::vector<Column> columns_;
  std::span<const float> range_m_;
  std::vector<std::int32_t> column_of_bin_;  // azimuth from 0 in equal steps, a power of two of them
  std::vector<std::int32_t> row_of_bin_;     // slope from the lowest in equal steps
  float bins_per_rad_ = 0, bins_per_slope_ = 0, lowest_slope_ = 0, mean_offset_m_ = 0;
};

}  // namespace pointreel
