// SensorRays: where the rays of a sensor's own grid meet planes.
//
// The ray of row k at column azimuth phi is a piece of the cone z = slope * rho + offset, turned by alpha and
// set off to the left by h. With a = phi + alpha it meets n.p = 1 at
//
//   rho = (1 - n_z offset + h (n_x sin a - n_y cos a)) / (n_x cos a + n_y sin a + n_z slope)
//
// but for h^2 / 2 rho (0.1 mm at 3 m for KITTI's 2.6 cm), which is the ray's own matter: points are where
// RayTable puts them. Sweeps as measured, before motion compensation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planes/plane_fit.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

class SensorRays {
 public:
  // `shift_of_row`: by how many columns each row of the image is turned against the grid (7.3 of the format).
  SensorRays(const SensorModel& model, const SweepGrid& grid, std::span<const std::size_t> shift_of_row);

  int rows() const { return static_cast<int>(rows_.size()); }
  int columns() const { return columns_; }

  struct Row {
    double slope, offset_m, side_offset_m, sin_alpha, cos_alpha, range_per_rho;
    std::size_t first;  // grid column of image column 0
    double azimuth_turns;
  };
  const Row& row(int row) const { return rows_[static_cast<std::size_t>(row)]; }
  // Of the column azimuths, by image column; those of a whole row, and of kColumnsMore, lie side by side.
  static constexpr std::size_t kColumnsMore = 16;
  const float* cos_of_row(int row) const { return &cos_[this->row(row).first]; }
  const float* sin_of_row(int row) const { return &sin_[this->row(row).first]; }

  // A plane as the rays of one row see it: rho = (at_zero + h (across sin - along cos)) / (along cos +
  // across sin + up), with the sines and cosines of column azimuths.
  struct RowPlane {
    float along, across, up, at_zero, side_offset_m, range_per_rho;

    float denominator(float cosine, float sine) const { return along * cosine + across * sine + up; }
    float numerator(float cosine, float sine) const {
      return at_zero + side_offset_m * (along * sine - across * cosine);
    }
  };
  RowPlane row_plane(const Plane& plane, int row) const {
    const Row& r = this->row(row);
    return {static_cast<float>(plane.x * r.cos_alpha + plane.y * r.sin_alpha),
            static_cast<float>(plane.y * r.cos_alpha - plane.x * r.sin_alpha),
            static_cast<float>(plane.z * r.slope),
            static_cast<float>(1 - plane.z * r.offset_m),
            static_cast<float>(r.side_offset_m),
            static_cast<float>(r.range_per_rho)};
  }

  // Ranges at which the rays of a row, image columns from `first` on, meet a plane; from 1 mm, also where
  // there is none, to 200 km. The same bits on every machine.
  void plane_ranges_m(const Plane& plane, int row, int first, std::span<float> range_m) const;

  // A direction in which rays look: cos and sin of the azimuth, slope, and the offset of its row.
  struct Direction {
    double cos, sin, slope, offset_m;
  };
  Direction direction(int row, int column) const;

  // The cell whose ray passes nearest to a point, give or take one; `from_row`: where to begin. None near the
  // axis, far beyond the outermost rows, or out of reach. The same on every machine.
  struct Cell {
    int row, column;
  };
  std::optional<Cell> cell_towards(double x_m, double y_m, double z_m, int from_row) const;

 private:
  int columns_;
  std::uint32_t ticks_per_turn_;
  std::vector<std::uint32_t> column_tick_;
  std::vector<Row> rows_;
  std::vector<float> cos_, sin_;  // of the column azimuths, twice around and kColumnsMore on
};

}  // namespace pointreel
