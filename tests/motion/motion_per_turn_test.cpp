// Registration of sweeps that take their time: the sensor moves on while it turns.
#include "motion/motion_per_turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "motion/registration.h"
#include "plane_scene.h"

namespace pointreel {
namespace {

constexpr double kMotionM = 1.4;  // from sweep to sweep, 14 m/s

// Pillars to both sides of the way.
std::vector<Pillar> avenue() {
  std::vector<Pillar> pillars;
  for (int i = -8; i < 24; ++i) pillars.push_back({{3.0 * i, i % 2 == 0 ? -4.5 : 5.0}, 0.4});
  return pillars;
}

// Sweep `i` of a sensor that drives ahead, `per_turn` of the motion a turn counterclockwise, from behind to
// behind.
SceneView sweep_on_the_way(int i, double per_turn) {
  const auto pose_at = [&](double azimuth_rad) {
    const double turns = std::remainder(azimuth_rad / (2 * std::numbers::pi), 1);
    return pose_of(kMotionM * (i + per_turn * turns), 0, 0, 0);
  };
  return view_along(tunnel(), pose_at, avenue());
}

struct WayBehind {
  MotionPerTurn per_turn;
  Pose last = Pose::Identity();
};

WayBehind drive(double per_turn, int sweeps) {
  WayBehind drive;
  SceneView before = sweep_on_the_way(0, per_turn);
  drive.last = pose_of(kMotionM, 0, 0, 0);
  for (int i = 1; i < sweeps; ++i) {
    SceneView now = sweep_on_the_way(i, per_turn);
    const Registration found =
        register_sweeps(before.grid(), now.grid(), drive.last, {}, drive.per_turn.value());
    EXPECT_TRUE(found.converged);
    drive.per_turn.learn(found.turning);
    drive.last = found.T_ref_cur;
    before = std::move(now);
  }
  return drive;
}

TEST(MotionPerTurn, IsLearntFromSweepsOnTheWay) {
  // Either way round; every second sweep; a sensor that sees all at once.
  for (const double per_turn : {1.0, -1.0, 0.5, -0.5, 0.0}) {
    const WayBehind found = drive(per_turn, 12);
    EXPECT_NEAR(found.per_turn.value(), per_turn, 0.15) << per_turn;
    EXPECT_NEAR(found.last.translation().x(), kMotionM, 0.01) << per_turn;
    EXPECT_NEAR(found.last.translation().y(), 0, 0.003) << per_turn;
  }
}

TEST(MotionPerTurn, SaysNothingAtRest) {
  const SceneView view = view_of(hall(), Pose::Identity());
  const Registration found = register_sweeps(view.grid(), view.grid());
  ASSERT_TRUE(found.converged);
  EXPECT_LT(found.turning.weight, 1e-6);
  MotionPerTurn per_turn;
  per_turn.learn(found.turning);
  EXPECT_NEAR(per_turn.value(), 0, 1e-3);
}

TEST(MotionPerTurn, StaysWithinAllOfTheMotionWhateverItIsTold) {
  MotionPerTurn per_turn;
  for (const double more : {100.0, -1e9, 3.0, 1e300}) {
    per_turn.learn({more, 1e6});
    EXPECT_LE(std::abs(per_turn.value()), 1);
  }
  per_turn.learn({});
  EXPECT_EQ(per_turn.value(), 1);
}

}  // namespace
}  // namespace pointreel
