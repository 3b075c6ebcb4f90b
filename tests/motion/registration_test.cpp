#include "motion/registration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "plane_scene.h"

namespace pointreel {
namespace {

double translation_error_m(const Pose& pose, const Pose& truth) {
  return (pose.translation() - truth.translation()).norm();
}
double rotation_error_deg(const Pose& pose, const Pose& truth) {
  return Eigen::AngleAxisd(pose.linear().transpose() * truth.linear()).angle() * 180 / std::numbers::pi;
}

TEST(Registration, FindsTheMotionWithoutAGuess) {
  const SceneView reference = view_of(hall(), Pose::Identity());
  for (const double forward_m : {0.0, 0.4, 1.3, 2.5, -1.3}) {
    for (const double yaw_deg : {0.0, 1.0, -4.0}) {
      const Pose truth = pose_of(forward_m, 0.05, -0.02, yaw_deg);
      const Registration found = register_sweeps(reference.grid(), view_of(hall(), truth).grid());
      EXPECT_TRUE(found.converged) << forward_m << " m, " << yaw_deg << " deg";
      EXPECT_LT(translation_error_m(found.T_ref_cur, truth), 0.01)
          << forward_m << " m, " << yaw_deg << " deg";
      EXPECT_LT(rotation_error_deg(found.T_ref_cur, truth), 0.05) << forward_m << " m, " << yaw_deg << " deg";
    }
  }
}

TEST(Registration, RefinesAGuess) {
  const SceneView reference = view_of(hall(), Pose::Identity());
  const Pose truth = pose_of(2.2, -0.1, 0.01, 3);
  const Registration found = register_sweeps(reference.grid(), view_of(hall(), truth).grid(),
                                             pose_of(2, 0, 0, 2.5), kQuickRegistration);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(translation_error_m(found.T_ref_cur, truth), 0.01);
  EXPECT_LT(rotation_error_deg(found.T_ref_cur, truth), 0.05);
}

// What the walls do not tell is taken from the guess; what they do is refined.
TEST(Registration, KeepsTheGuessAlongATunnel) {
  const SceneView reference = view_of(tunnel(), Pose::Identity());
  const Pose truth = pose_of(1.5, 0.1, 0, 1);
  const Pose guess = pose_of(1.4, 0, 0, 0.5);
  const Registration found = register_sweeps(reference.grid(), view_of(tunnel(), truth).grid(), guess);
  EXPECT_LT(found.weakest_share, 1e-3);
  EXPECT_NEAR(found.T_ref_cur.translation().x(), 1.4, 0.1);
  EXPECT_NEAR(found.T_ref_cur.translation().y(), 0.1, 0.01);
  EXPECT_LT(rotation_error_deg(found.T_ref_cur, truth), 0.05);
}

TEST(Registration, SaysWhenTheSweepsHaveNothingInCommon) {
  const SceneView reference = view_of(hall(), Pose::Identity());
  const SceneView elsewhere = view_of(hall(), pose_of(10, 3, 1, 70));
  EXPECT_FALSE(register_sweeps(reference.grid(), elsewhere.grid()).converged);
}

TEST(Registration, SurvivesAnyGrid) {
  const SceneView full = view_of(hall(), Pose::Identity());
  SceneView empty = full, sparse = full, infinite = full, one_row = full, no_columns;
  std::fill(empty.range_m.begin(), empty.range_m.end(), 0.0F);
  for (std::size_t i = 0; i < sparse.range_m.size(); ++i) {
    if (i % 97 != 0) sparse.range_m[i] = 0;
  }
  std::fill(infinite.range_m.begin(), infinite.range_m.end(), std::numeric_limits<float>::infinity());
  one_row.rows.resize(1);
  one_row.range_m.resize(one_row.column_azimuth_rad.size());
  no_columns.rows = full.rows;
  Pose not_a_number = Pose::Identity();
  not_a_number.translation().x() = std::numeric_limits<double>::quiet_NaN();
  for (const SceneView& reference : {full, empty, sparse, infinite, one_row, no_columns, SceneView{}}) {
    for (const SceneView& current : {full, empty, sparse, infinite, one_row, no_columns, SceneView{}}) {
      for (const std::optional<Pose>& guess :
           {std::optional<Pose>{}, std::optional<Pose>{pose_of(1e6, -1e6, 0, 90)},
            std::optional<Pose>{not_a_number}}) {
        const Registration found = register_sweeps(reference.grid(), current.grid(), guess);
        EXPECT_TRUE(found.T_ref_cur.matrix().allFinite());
        EXPECT_TRUE(std::isfinite(found.rms_m) && std::isfinite(found.inlier_share));
      }
    }
  }
  EXPECT_FALSE(register_sweeps(empty.grid(), full.grid()).converged);
  EXPECT_FALSE(register_sweeps(full.grid(), sparse.grid()).converged);
}

}  // namespace
}  // namespace pointreel
