// The steps of warping that look at each point by itself, in SIMD code.
#pragma once

#include <cstdint>
#include <vector>

#include "pointreel/motion.h"
#include "predict/coding_grid.h"
#include "predict/column_finder.h"
#include "predict/reference_sweep.h"
#include "predict/warped_points.h"
#include "sensor/sensor_model.h"

namespace pointreel {

// The image that points fall into: rows as cones, columns as azimuths.
struct WarpTarget {
  // Of the rows; the cones have a row before the first and one after the last, out of reach.
  std::vector<float> slope, offset_m;
  std::vector<float> azimuth_turns, side_turns_m, range_per_rho;
  std::vector<float> shift;  // whole columns by which a row is turned in the image
  ColumnFinder finder;
  int rows, columns;

  WarpTarget(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding);
};

// p_cur = rotation p_ref + translation_m, rotation row by row.
struct PointMotion {
  float rotation[9], translation_m[3];

  explicit PointMotion(const Pose& T_ref_cur);
};

// First step: finds the place of the points of one row of the reference.
void move_points(const ReferenceSweep& reference, int row, const PointMotion& motion,
                 const WarpTarget& target, WarpedPoints& points);

// Second step, after all rows have taken the first: finds the surfaces of the row's points.
void find_surfaces(int row, int columns, const WarpTarget& target, WarpedPoints& points);

}  // namespace pointreel
