#include "planes/temporal.h"

#include <gtest/gtest.h>

#include "planes/frame_coding.h"
#include "test_images.h"

namespace pointreel {
namespace {

constexpr float kThreshold_m = 0.05f;

FrameSettings settings() {
  FrameSettings settings;
  settings.tolerance = {kThreshold_m, kThreshold_m / 2};
  settings.residual_step_m = 2 * kThreshold_m;
  return settings;
}

// A wall `distance_m` ahead, seen 45 deg to either side by rows around the horizon.
RangeImage wall_ahead(const AngularGrid& grid, double distance_m) {
  RangeImage image = image_of_planes(grid, 192, 16, {{1 / distance_m, 0, 0}});
  for (int row = 0; row < image.rows; ++row) {
    for (int column = image.columns / 8; column < image.columns * 7 / 8; ++column) image.at(row, column) = 0;
  }
  return image;
}

TEST(TemporalPass, APlaneMovedAlongItsNormalIsReusedWithAShift) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  const CodedFrame key = encode_frame(grid, wall_ahead(grid, 10), settings(), nullptr, 1);
  ASSERT_EQ(key.statistics.unfit_cells, 0u);
  for (const double moved_m : {-2.0, -0.3, 0.0, 0.03, 0.3, 1.7}) {
    const RangeImage image = wall_ahead(grid, 10 + moved_m);
    const CodedFrame frame = encode_frame(grid, image, settings(), &key.decoded, 1);
    EXPECT_EQ(frame.statistics.spatial_cells, 0u) << moved_m;
    EXPECT_EQ(frame.statistics.unfit_cells, 0u) << moved_m;
    EXPECT_EQ(frame.statistics.temporal_cells, count_occupied(image)) << moved_m;
    for (const PlaneRun& run : frame.decoded.planes.runs) {
      EXPECT_EQ(run.kind, RunKind::temporal);
      // A shift of one is one plane step at the farthest cell, at most 14.2 m away by 45 deg.
      const double expected = moved_m / (10 * settings().tolerance.plane_step_m) * 14.2;
      EXPECT_NEAR(run.levels[0], expected, 3 + 0.35 * std::fabs(expected)) << moved_m;
    }
  }
}

TEST(TemporalPass, AStandingStillSceneIsReusedAndCostsLessThanItsKeyFrame) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  const RangeImage image = image_of_planes(grid, 192, 32, street_canyon());
  const CodedFrame key = encode_frame(grid, image, settings(), nullptr, 1);
  const CodedFrame again = encode_frame(grid, image, settings(), &key.decoded, 1);
  EXPECT_LT(again.bytes.size(), key.bytes.size());
  EXPECT_LT(3 * again.statistics.spatial_cells, again.statistics.temporal_cells);
}

TEST(TemporalPass, ATurnedPlaneIsNotReused) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  // A tile is 0.1 m wide on the wall: turned by 60 deg it spans 0.2 m of range, far more than the threshold.
  FrameSettings fine = settings();
  fine.tolerance = {0.005f, 0.0025};
  const CodedFrame key = encode_frame(grid, wall_ahead(grid, 10), fine, nullptr, 1);
  const double turn_rad = degrees_to_radians(60);
  RangeImage turned =
      image_of_planes(grid, 192, 16, {{0.1 * std::cos(turn_rad), 0.1 * std::sin(turn_rad), 0}});
  for (int row = 0; row < turned.rows; ++row) {
    for (int column = turned.columns / 8; column < turned.columns; ++column) turned.at(row, column) = 0;
  }
  const CodedFrame frame = encode_frame(grid, turned, fine, &key.decoded, 1);
  EXPECT_GE(frame.statistics.spatial_cells, 4000u);
  EXPECT_LT(10 * frame.statistics.temporal_cells, frame.statistics.spatial_cells);
}

TEST(TemporalPass, WorksBetweenDifferentBandsOfRows) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  const CodedFrame key =
      encode_frame(grid, image_of_planes(grid, 196, 8, street_canyon()), settings(), nullptr, 1);
  const RangeImage image = image_of_planes(grid, 188, 24, street_canyon());
  const CodedFrame frame = encode_frame(grid, image, settings(), &key.decoded, 1);
  EXPECT_GT(frame.statistics.temporal_cells, 0u);
  for (const PlaneRun& run : frame.decoded.planes.runs) {
    if (run.kind == RunKind::temporal) {
      EXPECT_TRUE(run.tile_row == 2 || run.tile_row == 3);
    }
  }
}

TEST(ShiftedPlane, MovesTheFarthestRangeByOneStepAShift) {
  const Plane wall{1 / 10.0, 0, 0};
  for (const std::int32_t shift : {-20, -1, 0, 1, 150}) {
    const Plane moved = shifted_plane(wall, shift, 12.5f, 0.02);
    EXPECT_NEAR(1 / moved.x, 10 * (1 + shift * 0.02 / 12.5), 1e-9);
    EXPECT_EQ(moved.y, 0);
  }
}

}  // namespace
}  // namespace pointreel
