// Clouds of every kind keep the promises of the header, alone and mixed in groups.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/clouds.h"
#include "support/codec_round_trip.h"

namespace pointreel {
namespace {

std::vector<EncoderOptions> varied_options() {
  std::vector<EncoderOptions> all(5, planes_options());
  all[1].planes.threshold_m = 0.001;
  all[2].planes.threshold_m = 10;
  all[3].planes.residual_mode = ResidualMode::raw_float;
  all[4].planes.residual_step_m = 0.5;
  all[4].planes.tile_size = 7;
  for (EncoderOptions& options : all) {
    // A coarse grid: small images, many points to a cell.
    options.planes.azimuth_step_rad = options.planes.elevation_step_rad = 0.02;
  }
  return all;
}

TEST(AwkwardClouds, EachByItself) {
  for (EncoderOptions options : varied_options()) {
    options.planes.group = 1;
    for (const NamedCloud& named : awkward_clouds()) {
      SCOPED_TRACE(named.name + ", threshold " + std::to_string(options.planes.threshold_m));
      check_round_trip({named.cloud}, options);
    }
  }
}

// Each cloud becomes the key frame of all others once.
TEST(AwkwardClouds, InGroupsWithAllOthers) {
  std::vector<PointCloud> clouds;
  for (NamedCloud& named : awkward_clouds()) clouds.push_back(std::move(named.cloud));
  for (EncoderOptions options : varied_options()) {
    options.planes.group = static_cast<int>(clouds.size());
    for (std::size_t turn = 0; turn < clouds.size(); ++turn) {
      std::rotate(clouds.begin(), clouds.begin() + 1, clouds.end());
      check_round_trip(clouds, options);
    }
  }
}

Pose any_motion() {
  const auto between = [](int low, int high) { return *rc::gen::inRange(low, high + 1) / 1000.0; };
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(between(-3142, 3142), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(between(-500, 500), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() << between(-20'000, 20'000), between(-20'000, 20'000), between(-2000, 2000);
  return pose;
}

RC_GTEST_PROP(AnyClouds, KeepTheBoundUnderAnyOptionsAndMotion, ()) {
  EncoderOptions options = planes_options();
  options.planes.azimuth_step_rad = *rc::gen::element(0.01, 0.033, 0.1);
  options.planes.elevation_step_rad = *rc::gen::element(0.01, 0.05);
  options.planes.threshold_m = *rc::gen::element(0.001, 0.05, 0.5, 10.0);
  options.planes.tile_size = *rc::gen::inRange(2, 17);
  options.planes.group = *rc::gen::inRange(1, 5);
  options.planes.residual_mode = *rc::gen::element(ResidualMode::stepped, ResidualMode::raw_float);
  std::vector<PointCloud> clouds;
  std::vector<Pose> poses;
  const int count = *rc::gen::inRange(1, 6);
  for (int i = 0; i < count; ++i) {
    const auto points = *rc::gen::inRange<std::size_t>(0, 2000);
    const auto range_m = *rc::gen::element(0.01f, 2.0f, 50.0f, 3000.0f);
    clouds.push_back(random_sphere(points, range_m, *rc::gen::arbitrary<std::uint32_t>()));
    poses.push_back(any_motion());
  }
  check_round_trip(clouds, options, poses);
  RC_ASSERT(!testing::Test::HasFailure());
}

}  // namespace
}  // namespace pointreel
