// The uniform angular grid of the paper: columns of equal azimuth, rows of equal elevation, rays at cell
// centres.
#pragma once

#include <cmath>
#include <vector>

#include "base/trigonometry.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

struct GridCell {
  int row = 0;     // 0 looks straight up, growing downwards
  int column = 0;  // 0 looks along +x, growing counter-clockwise
};

class AngularGrid {
 public:
  // Limits keep the tables small and a damaged header from asking for gigabytes.
  static constexpr double kMinStep_rad = 0.0003;  // 0.017 deg
  static constexpr double kMaxStep_rad = 0.1;     // 5.7 deg

  static Result<AngularGrid> create(double azimuth_step_rad, double elevation_step_rad);

  int rows() const { return rows_; }  // of the whole sphere
  int columns() const { return columns_; }
  double azimuth_step_rad() const { return azimuth_step_rad_; }
  double elevation_step_rad() const { return elevation_step_rad_; }

  // The cell that a point (x, y, z) != 0 falls into. Inline and without branches: projection loops are SIMD
  // code.
  GridCell cell_of(float x, float y, float z) const {
    const float azimuth = fast_atan2(y, x);
    const float from_zenith = fast_atan2(std::sqrt(x * x + y * y), z);
    const float turned = azimuth < 0 ? azimuth + static_cast<float>(kTurn) : azimuth;
    const int row = static_cast<int>(from_zenith * rows_per_rad_);
    const int column = static_cast<int>(turned * columns_per_rad_);
    return {row < rows_ ? row : rows_ - 1, column < columns_ ? column : columns_ - 1};
  }

  // Unit ray through a cell's centre: (cos_e cos_a, cos_e sin_a, sin_e). Rows may exceed rows() by up to
  // kSpareRows, so that tiles need not end at the pole.
  static constexpr int kSpareRows = 64;
  float cos_azimuth(int column) const { return cos_azimuth_[column]; }
  float sin_azimuth(int column) const { return sin_azimuth_[column]; }
  float cos_elevation(int row) const { return cos_elevation_[row]; }
  float sin_elevation(int row) const { return sin_elevation_[row]; }

 private:
  AngularGrid(double azimuth_step_rad, double elevation_step_rad);

  double azimuth_step_rad_;
  double elevation_step_rad_;
  float columns_per_rad_;
  float rows_per_rad_;
  int rows_;
  int columns_;
  std::vector<float> cos_azimuth_, sin_azimuth_;
  std::vector<float> cos_elevation_, sin_elevation_;
};

}  // namespace pointreel
