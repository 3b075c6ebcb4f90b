// RangeGrid: a sweep on its sensor's grid as registration sees it, and GridRays: its cells as points, its
// directions as cells.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
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
  int column_count() const { return static_cast<int>(cos_azimuth_.size()); }
  float range_m(int row, int column) const { return range_m_[index(row, column)]; }

  // Meaningless where there is no return.
  Eigen::Vector3f point_m(int row, int column) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    const auto c = static_cast<std::size_t>(column);
    const float rho_m = range_m(row, column) * r.cos_elevation;
    const float cosine = cos_azimuth_[c] * r.cos_azimuth - sin_azimuth_[c] * r.sin_azimuth;
    const float sine = sin_azimuth_[c] * r.cos_azimuth + cos_azimuth_[c] * r.sin_azimuth;
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

  struct Row {
    float slope, offset_m, azimuth_rad, side_offset_m, cos_elevation, cos_azimuth, sin_azimuth;
    std::int32_t turned_by;  // whole columns by which the row is ahead of the columns' azimuth, within a turn
  };
  // For SIMD code, which looks at many cells at once.
  std::span<const Row> rows() const { return rows_; }
  std::span<const float> ranges_m() const { return range_m_; }
  std::span<const float> cos_azimuth() const { return cos_azimuth_; }  // of the columns
  std::span<const float> sin_azimuth() const { return sin_azimuth_; }

  // Directions in equal steps.
  struct Directions {
    std::vector<std::int32_t> column_of_bin;  // azimuth from 0, a power of two of them
    std::vector<std::int32_t> row_of_bin;     // slope from the lowest
    float bins_per_rad = 0, bins_per_slope = 0, lowest_slope = 0, mean_offset_m = 0;
  };
  const Directions& directions() const { return directions_; }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * cos_azimuth_.size() + static_cast<std::size_t>(column);
  }

  std::vector<Row> rows_;
  std::vector<float> cos_azimuth_, sin_azimuth_;
  std::span<const float> range_m_;
  Directions directions_;
};

}  // namespace pointreel
