// Registration of sweeps that take their time: the sensor moves on while it turns.
#include "motion/motion_per_turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
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

// What a sensor does from sweep to sweep, `per_turn` of it a turn counterclockwise.
struct Way {
  double per_turn, yaw_deg = 0;
  int rows = 32;
};

// Where it is after a number of sweeps, along an arc.
Pose pose_on(const Way& way, double sweeps) {
  const double yaw_rad = way.yaw_deg * std::numbers::pi / 180, turned_rad = sweeps * yaw_rad;
  if (yaw_rad == 0) return pose_of(kMotionM * sweeps, 0, 0, 0);
  const double radius_m = kMotionM / yaw_rad;
  return pose_of(radius_m * std::sin(turned_rad), radius_m * (1 - std::cos(turned_rad)), 0,
                 sweeps * way.yaw_deg);
}

// Each sweep begins and ends behind the sensor.
SceneView sweep_on(const Way& way, int i) {
  const auto pose_at = [&](double azimuth_rad) {
    return pose_on(way, i + way.per_turn * std::remainder(azimuth_rad / (2 * std::numbers::pi), 1));
  };
  return view_along(tunnel(), pose_at, avenue(), way.rows);
}

struct Follower {
  MotionPerTurn per_turn;
  Pose last;
};

Follower follow(const Way& way, int sweeps) {
  Follower follower{{}, pose_on(way, 1)};
  SceneView before = sweep_on(way, 0);
  for (int i = 1; i < sweeps; ++i) {
    SceneView now = sweep_on(way, i);
    const Registration found =
        register_sweeps(before.grid(), now.grid(), follower.last, follower.per_turn.value());
    EXPECT_TRUE(found.converged);
    follower.per_turn.learn(found.turning);
    follower.last = found.T_ref_cur;
    before = std::move(now);
  }
  return follower;
}

TEST(MotionPerTurn, IsLearntFromSweepsOnTheWay) {
  // Either way round; every second sweep; a sensor that sees all at once; many rows.
  for (const Way& way : {Way{1}, Way{-1}, Way{0.5}, Way{-0.5}, Way{0}, Way{1, 0, 64}, Way{-1, 0, 64}}) {
    const Follower follower = follow(way, 12);
    EXPECT_NEAR(follower.per_turn.value(), way.per_turn, 0.15) << way.per_turn << ", " << way.rows << " rows";
    EXPECT_NEAR(follower.last.translation().x(), kMotionM, 0.01) << way.per_turn << ", " << way.rows;
    EXPECT_NEAR(follower.last.translation().y(), 0, 0.003) << way.per_turn << ", " << way.rows;
  }
}

TEST(MotionPerTurn, IsLearntInACurve) {
  for (const Way& way : {Way{1, 2}, Way{-1, 2}, Way{1, -2}, Way{-1, -2}}) {
    const Follower follower = follow(way, 8);
    EXPECT_GT(follower.per_turn.value() * way.per_turn, 0.7) << way.per_turn << ", " << way.yaw_deg;
  }
}

TEST(MotionPerTurn, IsKeptAtRest) {
  std::mt19937 random(1);
  const SceneView view = view_of(tunnel(), Pose::Identity(), avenue());
  MotionPerTurn per_turn = follow({-1}, 8).per_turn;
  const double driving = per_turn.value();
  for (int i = 0; i < 20; ++i) {
    const SceneView before = noisy(view, random), now = noisy(view, random);
    const Registration found = register_sweeps(before.grid(), now.grid(), Pose::Identity(), per_turn.value());
    ASSERT_TRUE(found.converged);
    // As many sweeps as in ten seconds.
    for (int sweep = 0; sweep < 100; ++sweep) per_turn.learn(found.turning);
    EXPECT_NEAR(per_turn.value(), driving, 0.05) << i;
  }
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
