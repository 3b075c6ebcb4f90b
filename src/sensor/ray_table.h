// RayTable: cells back to points. The decoder's half of the sensor model; the same bits on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

class RayTable {
 public:
  RayTable(const SensorModel& model, const SweepGrid& grid);

  std::size_t row_count() const { return rows_.size(); }
  std::size_t column_count() const { return columns_.size(); }

  // The decoded point; for compensated sweeps in the coordinates of the file. Any finite range will do.
  Point3f position(std::size_t row, std::size_t column, float range_m) const;
  // The same for the columns of a row from the first on, one range for each (what for is the caller's matter:
  // empty cells give some point): several times as fast.
  void positions_of_row(std::size_t row, std::span<const float> range_m, std::span<Point3f> positions) const;
  // As measured, before compensation: what neighbouring cells have in common.
  Point3f measured_position(std::size_t row, std::size_t column, float range_m) const;

 private:
  struct Row {
    double cos_elevation, slope, offset_m, side_offset_m, sin_azimuth, cos_azimuth, azimuth_rad;
    float cos_elevation_f, side_offset_m_f;
  };
  struct Column {
    double sin, cos, azimuth_rad;
  };
  struct Vector {
    double x, y, z;
  };
  struct Loops;
  Vector measured(const Row& row, const Column& column, double range_m) const;
  Vector compensated(const Vector& q, double azimuth_rad) const;
  Vector slightly_turned(const Vector& q, double s) const;
  Vector turned_back(const Vector& q, double s, double sine, double versine) const;

  std::vector<Row> rows_;
  std::vector<Column> columns_;
  bool compensated_ = false;
  Vector v_{}, axis_{};  // of the twist; axis of unit length, turning by s * angle_rad_
  double angle_rad_ = 0;
};

// Whole columns by which each row is turned: row r looks from column c into the direction in which a row with
// alpha 0 looks from column c + shift. alpha over the mean column step; 0 with fewer than two columns.
std::vector<std::int32_t> column_shift_of_row(const SensorModel& model, const SweepGrid& grid);

}  // namespace pointreel
