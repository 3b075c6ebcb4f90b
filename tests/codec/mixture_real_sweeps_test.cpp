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
    double bits = 0, points = 0;
    check_mixture_files(
        *paths, mixture_options(bound_m), [&](const Packet& packet, const DecodedSweep& decoded) {
          EXPECT_EQ(decoded.order_kept, GetParam().order_kept) << "frame " << decoded.frame;
          bits += 8.0 * static_cast<double>(serialize(packet).size()) - packet.statistics.field_bits;
          points += packet.points_in;
        });
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
