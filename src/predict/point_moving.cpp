#include "predict/point_moving.h"

#include <cmath>

#include "base/trigonometry.h"

// As in band_coding.cpp.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#define HWY_TARGET_INCLUDE "predict/point_moving.cpp"
#include "hwy/foreach_target.h"
//
#include "predict/point_moving-inl.h"
#include "predict/point_surfaces-inl.h"

#if HWY_ONCE
namespace pointreel {

HWY_EXPORT(move_points_of_row);
HWY_EXPORT(find_surfaces_of_row);

WarpTarget::WarpTarget(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding)
    : finder(grid), rows(static_cast<int>(coding.rows())), columns(static_cast<int>(coding.columns())) {
  constexpr float kOutOfReachM = 1e30F;
  slope.push_back(0);
  offset_m.push_back(kOutOfReachM);
  for (std::size_t row = 0; row < model.rows.size(); ++row) {
    const RowModel& at = model.rows[row];
    slope.push_back(static_cast<float>(at.slope));
    offset_m.push_back(static_cast<float>(at.offset_m));
    azimuth_turns.push_back(static_cast<float>(at.azimuth_rad / (2 * kPi)));
    side_turns_m.push_back(static_cast<float>(at.side_offset_m / (2 * kPi)));
    range_per_rho.push_back(static_cast<float>(std::sqrt(1 + at.slope * at.slope)));
    shift.push_back(static_cast<float>(coding.shift(row)));
  }
  slope.push_back(0);
  offset_m.push_back(kOutOfReachM);
}

PointMotion::PointMotion(const Pose& T_ref_cur) {
  // The inverse: p_cur = R^T (p_ref - t).
  const Eigen::Matrix3d r = T_ref_cur.linear();
  const Eigen::Vector3d t = T_ref_cur.translation();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation[3 * i + j] = static_cast<float>(r(j, i));
    translation_m[i] = static_cast<float>(-((r(0, i) * t(0) + r(1, i) * t(1)) + r(2, i) * t(2)));
  }
}

void move_points(const ReferenceSweep& reference, int row, const PointMotion& motion,
                 const WarpTarget& target, WarpedPoints& points) {
  HWY_DYNAMIC_DISPATCH(move_points_of_row)(reference, row, motion, target, points);
}

void find_surfaces(int row, int columns, const WarpTarget& target, WarpedPoints& points) {
  HWY_DYNAMIC_DISPATCH(find_surfaces_of_row)(row, columns, target, points);
}

}  // namespace pointreel
#endif  // HWY_ONCE
