// All real sweeps from $POINTREEL_DATA, which are not part of the repository, through method `mixture`.
#include <gtest/gtest.h>

#include <ostream>

#include "pointreel/io.h"
#include "support/clouds.h"
#include "support/mixture_round_trip.h"

namespace pointreel {
namespace {

struct RealSet {
  const char* folder;
  bool order_kept;
  double most_bits_per_point;  // geometry, at 2 cm
};

void PrintTo(const RealSet& set, std::ostream* out) {
  *out << set.folder;
}

class MixtureRealSweeps : public testing::TestWithParam<RealSet> {};

TEST_P(MixtureRealSweeps, KeepEveryPromise) {
  const auto data = real_data_folder();
  if (!data) GTEST_SKIP() << "POINTREEL_DATA is not set";
  const auto paths = expand_inputs(std::vector<std::string>{(*data / GetParam().folder).string()});
  ASSERT_TRUE(paths) << paths.error().message;
  for (const double bound_m : {0.001, 0.02, 0.2}) {
    const auto options = mixture_options(bound_m);
    auto encoder = Encoder::create(options);
    auto decoder = decoder_of(options);
    double bits = 0, points = 0;
    for (const auto& path : *paths) {
      SCOPED_TRACE(path.string() + " at " + std::to_string(bound_m));
      const auto cloud = read_cloud(path);
      ASSERT_TRUE(cloud) << cloud.error().message;
      const auto packets = encoder->encode(*cloud);
      ASSERT_TRUE(packets);
      const auto decoded = decoder.decode(*packets);
      ASSERT_TRUE(decoded[0]) << decoded[0].error().message;
      EXPECT_EQ(decoded[0]->order_kept, GetParam().order_kept);
      check_mixture_sweep(header_of(options), *cloud, packets->front(), *decoded[0]);
      bits += 8.0 * static_cast<double>(serialize(packets->front()).size()) -
              packets->front().statistics.field_bits;
      points += static_cast<double>(cloud->size());
    }
    if (bound_m == 0.02) {
      EXPECT_LT(bits / points, GetParam().most_bits_per_point);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, MixtureRealSweeps,
                         testing::Values(RealSet{"kitti_raw_0005", true, 2.02},
                                         RealSet{"kitti_raw_0001", true, 2.2},
                                         RealSet{"kitti_odometry_00", true, 2.2},
                                         RealSet{"ring_time_pcd", true, 2.9}),
                         [](const auto& set) { return std::string(set.param.folder); });

}  // namespace
}  // namespace pointreel
