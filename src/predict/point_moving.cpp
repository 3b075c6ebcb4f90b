#include "predict/point_moving.h"

#include <algorithm>
#include <cmath>

#include "base/simd_targets.h"
#include "base/trigonometry.h"

#define HWY_TARGET_INCLUDE "predict/point_moving.cpp"
#include "hwy/foreach_target.h"
//
#include "predict/point_moving-inl.h"
#include "predict/point_surfaces-inl.h"
#include "predict/warp_canvas-inl.h"

#if HWY_ONCE
namespace pointreel {

HWY_EXPORT(move_points_of_row);
HWY_EXPORT(find_surfaces_of_row);
HWY_EXPORT(average);
HWY_EXPORT(finish);

WarpSource::WarpSource(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding) {
  const std::size_t columns = coding.columns();
  for (std::size_t row = 0; row < model.rows.size(); ++row) {
    const RowModel& at = model.rows[row];
    const SinCos azimuth = sin_cos(at.azimuth_rad);
    rows.push_back({static_cast<float>(1 / std::sqrt(1 + at.slope * at.slope)), static_cast<float>(at.slope),
                    static_cast<float>(at.offset_m), static_cast<float>(at.side_offset_m),
                    static_cast<float>(azimuth.sin), static_cast<float>(azimuth.cos),
                    columns - coding.shift(row)});
  }
  constexpr std::size_t kLanes = 8;  // may begin at the last
  sin_azimuth.resize(2 * columns + kLanes);
  cos_azimuth.resize(2 * columns + kLanes);
  for (std::size_t c = 0; c < columns; ++c) {
    const double turns = static_cast<double>(grid.column_tick[c] % grid.ticks_per_turn) / grid.ticks_per_turn;
    const SinCos azimuth = sin_cos(turns * kTurn);
    sin_azimuth[c] = sin_azimuth[columns + c] = static_cast<float>(azimuth.sin);
    cos_azimuth[c] = cos_azimuth[columns + c] = static_cast<float>(azimuth.cos);
  }
}

WarpTarget::WarpTarget(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding)
    : finder(grid), rows(static_cast<int>(coding.rows())), columns(static_cast<int>(coding.columns())) {
  constexpr double kOutOfReachM = 1e30;
  constexpr double kLoneRowSlope = 1;
  const auto add_cone = [&](double cone_slope, double cone_offset_m) {
    slope.push_back(static_cast<float>(cone_slope));
    offset_m.push_back(static_cast<float>(cone_offset_m));
  };
  // As far beyond `end` as that is beyond the row before.
  const auto add_beyond = [&](const RowModel& end, const RowModel& before, double side) {
    if (model.rows.size() == 1) return add_cone(end.slope + side * kLoneRowSlope, end.offset_m);
    add_cone(2 * end.slope - before.slope, 2 * end.offset_m - before.offset_m);
  };
  const std::size_t last = model.rows.size() - 1;
  add_cone(0, kOutOfReachM);
  add_beyond(model.rows[0], model.rows[std::min<std::size_t>(1, last)], 1);
  for (std::size_t row = 0; row < model.rows.size(); ++row) {
    const RowModel& at = model.rows[row];
    add_cone(at.slope, at.offset_m);
    azimuth_turns.push_back(static_cast<float>(at.azimuth_rad / kTurn));
    side_turns_m.push_back(static_cast<float>(at.side_offset_m / kTurn));
    range_per_rho.push_back(static_cast<float>(std::sqrt(1 + at.slope * at.slope)));
    shift.push_back(static_cast<float>(coding.shift(row)));
  }
  add_beyond(model.rows[last], model.rows[last - std::min<std::size_t>(1, last)], -1);
  add_cone(0, -kOutOfReachM);
}

PointMotion::PointMotion(const SweepMotion& motion) : per_sine(static_cast<float>(motion.per_turn / kTurn)) {
  // The inverse: p_cur = R^T (p_ref - t).
  const Eigen::Matrix3d r = motion.T_ref_cur.linear();
  const Eigen::Vector3d t = motion.T_ref_cur.translation();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation[3 * i + j] = static_cast<float>(r(j, i));
    translation_m[i] = static_cast<float>(-((r(0, i) * t(0) + r(1, i) * t(1)) + r(2, i) * t(2)));
  }
}

void move_points(const GridImage& reference, int row, const WarpSource& source, const PointMotion& motion,
                 const WarpTarget& target, WarpedPoints& points) {
  HWY_DYNAMIC_DISPATCH(move_points_of_row)(reference, row, source, motion, target, points);
}

void find_surfaces(int row, int columns, const WarpTarget& target, const WarpCanvas& canvas,
                   WarpedPoints& points) {
  HWY_DYNAMIC_DISPATCH(find_surfaces_of_row)(row, columns, target, canvas, points);
}

void average_row(int row, WarpCanvas& canvas) {
  HWY_DYNAMIC_DISPATCH(average)(row, canvas);
}

void finish_row(const WarpCanvas& canvas, int row, const ReturnsBefore& before, ReferenceImage& image) {
  HWY_DYNAMIC_DISPATCH(finish)(canvas, row, before, image);
}

}  // namespace pointreel
#endif  // HWY_ONCE
