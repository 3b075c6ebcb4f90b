// The steps of warping that look at each point by itself, in SIMD code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/sweep_motion.h"
#include "predict/coding_grid.h"
#include "predict/column_finder.h"
#include "predict/grid_image.h"
#include "predict/warp_canvas.h"
#include "predict/warped_points.h"
#include "sensor/sensor_model.h"

namespace pointreel {

// The rays that points come from, as measured, without motion compensation: a point at distance rho from the
// axis lies at the azimuths of its row and column together, turned by atan2(side offset, rho).
struct WarpSource {
  struct Row {
    float cos_elevation, slope, offset_m, side_offset_m, sin_azimuth, cos_azimuth;
    std::size_t first_column;  // sensor column of the image's first
  };
  std::vector<Row> rows;
  std::vector<float> sin_azimuth, cos_azimuth;  // of the columns, twice around: rows are turned

  WarpSource(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding);
};

// The image that points fall into: rows as cones, columns as azimuths.
struct WarpTarget {
  // Of the cones: kRowsAround more before the first and after the last, the inner ones a step away as the
  // rows are, the outer ones out of reach.
  static constexpr int kRowsAround = 2;
  std::vector<float> slope, offset_m;
  // Of the rows.
  std::vector<float> azimuth_turns, side_turns_m, range_per_rho;
  std::vector<float> shift;  // whole columns by which a row is turned in the image
  ColumnFinder finder;
  int rows, columns;

  WarpTarget(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding);
};

// p_cur = rotation p_ref + (1 + per_sine sin(a_cur - a_ref)) translation_m, rotation row by row; azimuths
// a_cur without that sine (SweepMotion).
struct PointMotion {
  float rotation[9], translation_m[3];
  float per_sine;

  explicit PointMotion(const SweepMotion& motion);
};

// First step: finds the place of the points of one row of the reference.
void move_points(const GridImage& reference, int row, const WarpSource& source, const PointMotion& motion,
                 const WarpTarget& target, WarpedPoints& points);

// Second step, after all rows have taken the first: finds the surfaces of the row's points, and their cells.
void find_surfaces(int row, int columns, const WarpTarget& target, const WarpCanvas& canvas,
                   WarpedPoints& points);

}  // namespace pointreel
