// Real sweeps from $POINTREEL_DATA, which are not part of the repository.
#include <gtest/gtest.h>

#include "grid_checks.h"
#include "pointreel/io.h"
#include "sensor/sensor_estimator.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

struct RealSet {
  const char* folder;
  std::size_t rows;
  std::uint32_t ticks_per_turn;
  bool compensated, rings;
  double p95_m, range_step_m;
};

void PrintTo(const RealSet& set, std::ostream* stream) {
  *stream << set.folder;
}

class RealSensors : public testing::TestWithParam<RealSet> {};

TEST_P(RealSensors, AreRecoveredFromTheirFirstSweep) {
  const auto data = real_data_folder();
  if (!data) GTEST_SKIP() << "POINTREEL_DATA is not set";
  const RealSet set = GetParam();
  const auto paths = expand_inputs(std::vector<std::string>{(*data / set.folder).string()});
  ASSERT_TRUE(paths) << paths.error().message;
  std::vector<GriddedSweep> sweeps;
  SensorEstimator estimator;
  for (std::size_t i = 0; i < std::min<std::size_t>(4, paths->size()); ++i) {
    const auto cloud = read_cloud((*paths)[i]);
    ASSERT_TRUE(cloud) << cloud.error().message;
    if (i == 0) estimator.add(*cloud);
    ASSERT_TRUE(estimator.model());
    sweeps.push_back(project(*estimator.model(), *cloud, {}, sweeps.empty() ? nullptr : &sweeps.back().grid));
    check_grid(*estimator.model(), *cloud, sweeps.back());
  }
  const SensorModel& model = *estimator.model();
  EXPECT_EQ(model.rows.size(), set.rows);
  EXPECT_EQ(model.ticks_per_turn, set.ticks_per_turn);
  EXPECT_EQ(model.motion_compensated, set.compensated);
  EXPECT_DOUBLE_EQ(model.range_step_m, set.range_step_m);
  EXPECT_EQ(!model.ring_of_row.empty(), set.rings);
  EXPECT_LE(encode_sensor_model(model).size(), 450u);
  const SensorDiagnosis diagnosis = diagnose(model, sweeps);
  EXPECT_LT(diagnosis.deviation.p95_m, set.p95_m);
  EXPECT_GT(count_of(diagnosis, StrayReason::none) * 1000, diagnosis.points * 995);
}

INSTANTIATE_TEST_SUITE_P(Sets, RealSensors,
                         testing::Values(RealSet{"kitti_raw_0005", 64, 4000, false, false, 1e-3, 2e-3},
                                         RealSet{"kitti_raw_0001", 64, 4000, false, false, 1e-3, 2e-3},
                                         RealSet{"kitti_odometry_00", 64, 4000, true, false, 1e-3, 2e-3},
                                         RealSet{"ring_time_pcd", 61, 1800, false, true, 1e-3, 4e-3}),
                         [](const auto& set) { return std::string(set.param.folder); });

}  // namespace
}  // namespace pointreel
