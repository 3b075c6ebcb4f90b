// Method `planes` on the sensor's grid: all that method `mixture` promises, and the planes themselves.
#include <gtest/gtest.h>

#include <map>

#include "pointreel/io.h"
#include "support/clouds.h"
#include "support/expect_error.h"
#include "support/mixture_round_trip.h"

namespace pointreel {
namespace {

std::size_t bytes_of(const std::vector<Packet>& packets) {
  std::size_t bytes = 0;
  for (const Packet& packet : packets) bytes += packet.payload.size();
  return bytes;
}

class SensorPlanes : public testing::Test {
 protected:
  static void SetUpTestSuite() { sweeps_ = clouds_of(simulated_drive(6)); }
  static inline std::vector<PointCloud> sweeps_;
};

TEST_F(SensorPlanes, EveryEffortGroupAndBoundKeepsEveryPromise) {
  for (const Effort effort : {Effort::fast, Effort::balanced, Effort::max}) {
    for (const double bound_m : {0.002, 0.05, 1.0}) {
      for (const int group : {1, 3}) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(effort) << ", " << bound_m << " m, group " << group);
        check_mixture_round_trip(sweeps_, sensor_planes(bound_m, effort, group));
      }
    }
  }
}

TEST_F(SensorPlanes, CompensatedAndAwkwardCloudsComeBack) {
  for (const Effort effort : {Effort::fast, Effort::balanced}) {
    for (const NamedCloud& named : awkward_clouds()) {
      SCOPED_TRACE(named.name);
      check_mixture_round_trip({named.cloud}, sensor_planes(0.05, effort));
    }
  }
}

TEST_F(SensorPlanes, TheBytesDoNotDependOnThreads) {
  const auto options = sensor_planes(0.05);
  const auto one = encode_all(sweeps_, options, {}, 1), four = encode_all(sweeps_, options, {}, 4);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].payload, four[i].payload);
}

TEST_F(SensorPlanes, ManyCellsLieOnPlanesAndManyOfThoseOnTheOnesOfTheSweepBefore) {
  std::uint64_t spatial = 0, temporal = 0, unfit = 0;
  for (const Packet& packet : encode_all(sweeps_, sensor_planes(0.1))) {
    spatial += packet.statistics.spatial_cells;
    temporal += packet.statistics.temporal_cells;
    unfit += packet.statistics.unfit_cells;
  }
  EXPECT_GT(3 * (spatial + temporal), 2 * unfit);
  EXPECT_GT(5 * temporal, spatial);
}

TEST_F(SensorPlanes, TheyDoNotCostBits) {
  for (const double bound_m : {0.05, 0.2}) {
    EXPECT_LT(static_cast<double>(bytes_of(encode_all(sweeps_, sensor_planes(bound_m)))),
              1.02 * static_cast<double>(bytes_of(encode_all(sweeps_, mixture_options(bound_m)))));
  }
}

TEST_F(SensorPlanes, PlanesComeWithoutThePointsAndHoldThem) {
  constexpr double kBoundM = 0.1;
  const auto options = sensor_planes(kBoundM);
  const auto packets = encode_all(sweeps_, options);
  const auto planes = decoder_of(options).decode_planes(packets);
  ASSERT_EQ(planes.size(), packets.size());
  for (std::size_t i = 0; i < packets.size(); ++i) {
    ASSERT_TRUE(planes[i]) << planes[i].error().message;
    EXPECT_EQ(planes[i]->frame, i);
    EXPECT_EQ(planes[i]->planes.size(), packets[i].statistics.runs);
    EXPECT_GT(planes[i]->planes.size(), 5u);
    std::map<std::uint32_t, std::uint32_t> tiles, cells;
    std::uint32_t all_cells = 0;
    for (const PlaneTile& tile : planes[i]->tiles) {
      ASSERT_LT(tile.plane, planes[i]->planes.size());
      ++tiles[tile.plane];
      cells[tile.plane] += tile.cells;
      all_cells += tile.cells;
      const SweepPlane& plane = planes[i]->planes[tile.plane];
      const Eigen::Vector3d center_m = tile.center_m.cast<double>();
      EXPECT_NEAR(plane.normal.dot(center_m), plane.distance_m, 1e-3);
      EXPECT_LE(std::fabs(plane.long_axis.dot(center_m - plane.center_m)), plane.length_m + 1e-3);
    }
    const FrameStatistics& statistics = packets[i].statistics;
    const std::uint32_t points = statistics.spatial_cells + statistics.temporal_cells;
    EXPECT_GE(all_cells, points) << "cells with a return are among those with or without one";
    EXPECT_LT(2 * all_cells, 3 * points);
    for (std::uint32_t p = 0; p < planes[i]->planes.size(); ++p) {
      const SweepPlane& plane = planes[i]->planes[p];
      EXPECT_EQ(plane.tiles, tiles[p]);
      EXPECT_EQ(plane.cells, cells[p]);
      EXPECT_NEAR(plane.normal.norm(), 1, 1e-9);
      EXPECT_GT(plane.distance_m, 0);
      EXPECT_NEAR(plane.normal.dot(plane.long_axis), 0, 1e-9);
    }
  }
  // The road lies level, about two metres below.
  std::uint32_t largest = 0;
  const SweepPlane* road = nullptr;
  for (const SweepPlane& plane : planes[0]->planes) {
    if (plane.cells <= largest) continue;
    largest = plane.cells;
    road = &plane;
  }
  EXPECT_LT(road->normal.z(), -0.99);
  EXPECT_NEAR(road->distance_m, 1.8, 0.5);
}

TEST_F(SensorPlanes, PlanesAloneAndPointsMayBeDecodedInTurns) {
  const auto options = sensor_planes(0.1, Effort::balanced, 3);
  const auto packets = encode_all(sweeps_, options);
  const auto expected = decoder_of(options).decode_planes(packets);
  Decoder decoder = decoder_of(options);
  const auto tiles_of = [&](std::size_t i) {
    const auto planes = decoder.decode_planes({&packets[i], 1});
    return planes[0] ? planes[0]->tiles.size() : std::size_t{0};
  };
  ASSERT_TRUE(decoder.decode({packets.data(), 1})[0]);
  EXPECT_EQ(tiles_of(1), expected[1]->tiles.size()) << "from the planes that decode() met";
  expect_error(decoder.decode({&packets[2], 1})[0], ErrorCode::corrupt, "reference frame 1 was not decoded");
  EXPECT_EQ(tiles_of(2), expected[2]->tiles.size());
  ASSERT_TRUE(decoder.decode({&packets[3], 1})[0]) << "a key frame";
  expect_error(decoder.decode_planes({&packets[5], 1})[0], ErrorCode::corrupt,
               "frame 5: its reference frame 4");
}

TEST_F(SensorPlanes, OtherStreamsHaveNone) {
  for (const EncoderOptions& options : {mixture_options(0.1), planes_options()}) {
    const auto packets = encode_all({sweeps_[0]}, options);
    expect_error(decoder_of(options).decode_planes(packets)[0], ErrorCode::unsupported, "only method planes");
  }
  const auto scattered = encode_all({random_sphere(300, 5, 1)}, sensor_planes(0.1));
  const auto planes = decoder_of(sensor_planes(0.1)).decode_planes(scattered);
  ASSERT_TRUE(planes[0]);
  EXPECT_TRUE(planes[0]->planes.empty());
}

class SensorPlanesOnRealSweeps : public testing::TestWithParam<const char*> {};

TEST_P(SensorPlanesOnRealSweeps, EveryPointIsWithinTheBound) {
  const auto data = real_data_folder();
  if (!data) GTEST_SKIP() << "POINTREEL_DATA is not set";
  auto paths = expand_inputs(std::vector<std::string>{(*data / GetParam()).string()});
  ASSERT_TRUE(paths) << paths.error().message;
  constexpr std::size_t kMostSweeps = 7;
  paths->resize(std::min(paths->size(), kMostSweeps));
  for (const Effort effort : {Effort::fast, Effort::balanced}) {
    for (const double bound_m : {0.02, 0.1}) {
      std::uint64_t on_planes = 0, unfit = 0;
      check_mixture_files(*paths, sensor_planes(bound_m, effort, 5),
                          [&](const Packet& packet, const DecodedSweep&) {
                            on_planes += packet.statistics.spatial_cells + packet.statistics.temporal_cells;
                            unfit += packet.statistics.unfit_cells;
                          });
      if (effort == Effort::fast && bound_m == 0.1) {
        EXPECT_GT(static_cast<double>(on_planes), 0.55 * static_cast<double>(on_planes + unfit));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, SensorPlanesOnRealSweeps,
                         testing::Values("kitti_raw_0005", "kitti_raw_0001", "kitti_odometry_00",
                                         "ring_time_pcd"),
                         [](const auto& set) { return std::string(set.param); });

}  // namespace
}  // namespace pointreel
