// Real sweeps from $POINTREEL_DATA, which are not part of the repository.
#include <gtest/gtest.h>

#include "pointreel/io.h"
#include "support/clouds.h"
#include "support/codec_round_trip.h"

namespace pointreel {
namespace {

class RealSweepsRoundTrip : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto data = real_data_folder();
    if (!data) GTEST_SKIP() << "POINTREEL_DATA is not set";
    folder_ = *data / GetParam();
    const auto paths = expand_inputs(std::vector<std::string>{folder_.string()});
    ASSERT_TRUE(paths) << paths.error().message;
    ASSERT_GE(paths->size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      auto cloud = read_cloud((*paths)[i]);
      ASSERT_TRUE(cloud) << cloud.error().message;
      sweeps_.push_back(*std::move(cloud));
    }
  }

  std::filesystem::path folder_;
  std::vector<PointCloud> sweeps_;
};

TEST_P(RealSweepsRoundTrip, KeepEveryPromise) {
  for (const double threshold_m : {0.02, 0.1}) {
    EncoderOptions options = planes_options();
    options.planes.group = 3;
    options.planes.threshold_m = threshold_m;
    check_round_trip(sweeps_, options);
  }
}

TEST_P(RealSweepsRoundTrip, WithTheirPoses) {
  if (!std::filesystem::exists(folder_ / "poses.txt")) GTEST_SKIP() << "no poses in " << folder_;
  auto poses = read_kitti_poses(folder_ / "poses.txt");
  ASSERT_TRUE(poses) << poses.error().message;
  poses->resize(sweeps_.size());
  EncoderOptions options = planes_options();
  options.planes.group = 3;
  check_round_trip(sweeps_, options, *poses);
}

INSTANTIATE_TEST_SUITE_P(Sets, RealSweepsRoundTrip,
                         testing::Values("kitti_raw_0001", "kitti_raw_0005", "kitti_odometry_00",
                                         "ring_time_pcd"),
                         [](const auto& set) { return std::string(set.param); });

}  // namespace
}  // namespace pointreel
