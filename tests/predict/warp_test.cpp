// The warped reference: what a sweep says about another place.
#include "predict/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "predict/coding_grid.h"
#include "sensor/ray_table.h"

namespace pointreel {
namespace {

SensorModel sensor(int rows) {
  SensorModel model;
  for (int row = 0; row < rows; ++row) {
    model.rows.push_back(rounded(
        {0.05 - 0.4 * row / rows, row % 2 == 0 ? 0.1 : 0.15, row % 3 * 0.04, row % 2 == 0 ? 0.026 : -0.026}));
    model.row_sequence.push_back(static_cast<std::uint16_t>(row));
  }
  model.ticks_per_turn = 4000;
  return model;
}

SweepGrid full_turn(std::uint32_t first_tick = 0) {
  SweepGrid grid;
  grid.ticks_per_turn = 4000;
  for (std::uint32_t tick = first_tick; tick < 4000; tick += 2) grid.column_tick.push_back(tick);
  return grid;
}

// A room of 20 x 14 m, floor 1.8 m below: the range along each ray, from a sensor at `x_m`, `y_m` that moves
// along x by `x_per_turn_m` while it turns once.
GridImage room_from(const SensorModel& model, const SweepGrid& grid, double x_m, double y_m, double yaw_rad,
                    double x_per_turn_m = 0) {
  const CodingGrid coding(model, grid);
  const RayTable rays(model, grid);
  std::vector<float> range_of_cell_m(coding.rows() * coding.columns());
  for (std::size_t row = 0; row < coding.rows(); ++row) {
    for (std::size_t column = 0; column < coding.columns(); ++column) {
      const auto inside = [&](float range_m) {
        const Point3f p = rays.measured_position(row, column, range_m);
        const double turns = std::atan2(p.y, p.x) / kTurn;
        const double x = x_m + x_per_turn_m * turns + std::cos(yaw_rad) * p.x - std::sin(yaw_rad) * p.y;
        const double y = y_m + std::sin(yaw_rad) * p.x + std::cos(yaw_rad) * p.y;
        return std::fabs(x) < 10 && std::fabs(y) < 7 && p.z > -1.8F && p.z < 3;
      };
      float near_m = 0, far_m = 60;
      for (int i = 0; i < 40; ++i)
        (inside(0.5F * (near_m + far_m)) ? near_m : far_m) = 0.5F * (near_m + far_m);
      range_of_cell_m[row * coding.columns() + column] = near_m;
    }
  }
  return coding.image_of(range_of_cell_m, 1);
}

Pose moved(double x_m, double y_m, double yaw_rad) {
  Pose pose = Pose::Identity();
  pose.translate(Eigen::Vector3d(x_m, y_m, 0));
  pose.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  return pose;
}

ReferenceImage warp(const SensorModel& model, const SweepGrid& grid, const ReferenceSweep& reference,
                    const Pose& T_ref_cur, int threads, double per_turn = 0) {
  WarpMemory memory;
  return pointreel::warp(model, grid, reference, {T_ref_cur, per_turn}, threads, memory);
}

TEST(Warp, ShowsARoomFromAnotherPlace) {
  const SensorModel model = sensor(32);
  const SweepGrid reference_grid = full_turn(), grid = full_turn(1);
  const GridImage before = room_from(model, reference_grid, 0, 0, 0);
  const ReferenceSweep reference{reference_grid, before, {}};
  for (const auto& [x_m, y_m, yaw_rad] : {std::tuple{0.0, 0.0, 0.0}, {1.3, 0.1, 0.02}, {-0.5, 0.4, -0.3}}) {
    const GridImage now = room_from(model, grid, x_m, y_m, yaw_rad);
    const ReferenceImage warped = warp(model, grid, reference, moved(x_m, y_m, yaw_rad), 1);
    ASSERT_EQ(warped.range_m.size(), now.range_m.size());
    std::vector<float> errors_m;
    for (std::size_t i = 0; i < now.range_m.size(); ++i) {
      if (warped.range_m[i] > 0) errors_m.push_back(std::fabs(warped.range_m[i] - now.range_m[i]));
    }
    EXPECT_GT(static_cast<double>(errors_m.size()), 0.85 * static_cast<double>(now.range_m.size()));
    std::sort(errors_m.begin(), errors_m.end());
    EXPECT_LT(errors_m[errors_m.size() / 2], 0.002F) << x_m;
    EXPECT_LT(errors_m[errors_m.size() * 9 / 10], 0.1F) << x_m;
  }
}

// Far to the side of the wall ahead: what the sensor passes is seen earlier or later in the next turn.
TEST(Warp, GoesByTheTimeAtWhichAPlaceIsSeen) {
  const SensorModel model = sensor(32);
  const SweepGrid reference_grid = full_turn(), grid = full_turn(1);
  constexpr double kMotionM = 1.5;
  const auto median_off_m = [&](const ReferenceImage& warped, const GridImage& now) {
    constexpr int kRowsAboveTheFloor = 12;
    std::vector<float> off_m;
    for (int row = 0; row < kRowsAboveTheFloor; ++row) {
      for (int column = now.columns / 16; column < now.columns / 12; ++column) {  // 22 to 30 degrees
        const std::size_t cell = now.index(row, column);
        if (warped.range_m[cell] > 0) off_m.push_back(std::fabs(warped.range_m[cell] - now.range_m[cell]));
      }
    }
    std::nth_element(off_m.begin(), off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2),
                     off_m.end());
    return off_m.at(off_m.size() / 2);
  };
  for (const auto& [per_turn, yaw_rad] :
       {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.5, 0.0}, {1.0, 0.1}, {-1.0, 0.1}}) {
    const ReferenceSweep reference{
        reference_grid, room_from(model, reference_grid, 0, 0, 0, per_turn * kMotionM), {}};
    const GridImage now = room_from(model, grid, kMotionM, 0, yaw_rad, per_turn * kMotionM);
    const Pose motion = moved(kMotionM, 0, yaw_rad);
    EXPECT_LT(median_off_m(warp(model, grid, reference, motion, 1, per_turn), now), 0.003F)
        << per_turn << ", " << yaw_rad;
    EXPECT_GT(median_off_m(warp(model, grid, reference, motion, 1), now), 0.005F)
        << per_turn << ", " << yaw_rad;
  }
}

// Firing order: columns from anywhere, through more than a turn.
TEST(Warp, FindsColumnsWhereverTheSweepBegins) {
  const SensorModel model = sensor(8);
  const SweepGrid reference_grid = full_turn();
  const ReferenceSweep reference{reference_grid, room_from(model, reference_grid, 0, 0, 0), {}};
  for (const std::uint32_t first : {0u, 900u, 2001u, 3999u}) {
    for (const std::uint32_t ticks : {4000u, 4400u}) {
      SweepGrid grid;
      grid.ticks_per_turn = 4000;
      for (std::uint32_t tick = first; tick < first + ticks; tick += 2) grid.column_tick.push_back(tick);
      const GridImage now = room_from(model, grid, 0, 0, 0);
      const ReferenceImage warped = warp(model, grid, reference, Pose::Identity(), 1);
      std::size_t near = 0;
      for (std::size_t i = 0; i < now.range_m.size(); ++i)
        near += std::fabs(warped.range_m[i] - now.range_m[i]) < 0.05F ? 1 : 0;
      // What comes a second time has no reference.
      EXPECT_GT(static_cast<double>(near), 0.95 * 4000 / ticks * static_cast<double>(now.range_m.size()))
          << first << ", " << ticks;
    }
  }
}

// A sensor that looks ahead only: what has left its view is gone, not at the other edge.
TEST(Warp, PointsBesideAPartialViewAreDropped) {
  const SensorModel model = sensor(8);
  SweepGrid grid;
  grid.ticks_per_turn = 4000;
  for (std::uint32_t tick = 1000; tick < 2000; tick += 2) grid.column_tick.push_back(tick);
  GridImage image = CodingGrid(model, grid).empty_image();
  std::fill(image.range_m.begin(), image.range_m.end(), 10.0F);
  const ReferenceSweep reference{grid, image, {}};
  const ReferenceImage warped = warp(model, grid, reference, moved(0, 0, 0.5), 1);
  std::size_t returns = 0;
  for (const float range_m : warped.range_m) returns += range_m > 0 ? 1 : 0;
  const double kept = 1 - 0.5 / (kTurn / 4);
  EXPECT_NEAR(static_cast<double>(returns), kept * static_cast<double>(warped.range_m.size()),
              0.05 * static_cast<double>(warped.range_m.size()));
}

TEST(Warp, IsTheSameForAnyNumberOfThreads) {
  const SensorModel model = sensor(16);
  const SweepGrid grid = full_turn();
  const ReferenceSweep reference{grid, room_from(model, grid, 0, 0, 0), {}};
  const ReferenceImage one = warp(model, grid, reference, moved(0.7, 0, 0.05), 1);
  const ReferenceImage four = warp(model, grid, reference, moved(0.7, 0, 0.05), 4);
  EXPECT_EQ(one.range_m, four.range_m);
  EXPECT_EQ(one.hits, four.hits);
}

TEST(DrawTogether, AveragesWithinTheBinAndOnOneSurface) {
  GridImage decoded{1, 6, {10, 10, 10, 0, 10, 10}};
  draw_together({1, 6, {10.02F, 10.07F, 10.2F, 10, 0, 9.95F}, {}}, 0.04F, decoded);
  const float expected_m[] = {10.006F, 10.012F, 10, 0, 10, 9.988F};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(decoded.range_m[i], expected_m[i], 1e-5F) << i;
}

// Sweeps of one stream take the memory of the sweep before, whatever size that had.
TEST(Warp, DoesNotDependOnWhatItsMemoryHeld) {
  const SensorModel model = sensor(8);
  WarpMemory memory;
  for (const std::size_t columns : {2000u, 1999u, 1200u, 1207u, 2000u}) {
    SweepGrid grid = full_turn();
    grid.column_tick.resize(columns);
    const ReferenceSweep reference{grid, room_from(model, grid, 0, 0, 0), {}};
    const SweepMotion motion{moved(0.7, 0, 0.05), -1};
    const ReferenceImage& reused = pointreel::warp(model, grid, reference, motion, 1, memory);
    const ReferenceImage fresh = warp(model, grid, reference, motion.T_ref_cur, 1, motion.per_turn);
    EXPECT_EQ(reused.range_m, fresh.range_m) << columns;
    EXPECT_EQ(reused.hits, fresh.hits) << columns;
  }
}

// Whatever a damaged stream says about the motion.
TEST(Warp, StaysFiniteForAnyMotionAndAnyGrid) {
  const SensorModel model = sensor(5);
  for (const std::size_t columns : {1u, 2u, 3u, 700u}) {
    SweepGrid grid = full_turn();
    grid.column_tick.resize(columns);
    const GridImage image{5, static_cast<int>(columns), std::vector<float>(5 * columns, 4.0F)};
    const ReferenceSweep reference{grid, image, {}};
    for (const double far_m : {0.0, 4.0, 1e6, 1e30, static_cast<double>(std::numeric_limits<float>::max())}) {
      for (const double per_turn : {-1.0, 0.0, 1.0}) {
        const ReferenceImage warped = warp(model, grid, reference, moved(far_m, -far_m, kPi), 1, per_turn);
        for (const float range_m : warped.range_m) ASSERT_TRUE(std::isfinite(range_m) && range_m >= 0);
      }
    }
  }
}

}  // namespace
}  // namespace pointreel
