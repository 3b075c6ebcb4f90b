// The motion between encoded sweeps from their planes alone, against the poses of real drives.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "pointreel/codec.h"
#include "pointreel/io.h"
#include "pointreel/motion.h"
#include "pointreel/planes.h"
#include "support/clouds.h"
#include "support/mixture_round_trip.h"

namespace pointreel {
namespace {

std::vector<SweepPlanes> planes_of(const std::vector<PointCloud>& sweeps, double bound_m) {
  EncoderOptions options = sensor_planes(bound_m, Effort::fast, 255);
  options.mixture.fields.all_others = false;
  Encoder encoder = *Encoder::create(options, Runtime{1});
  Decoder decoder = *Decoder::create(encoder.header(), Runtime{1});
  std::vector<SweepPlanes> planes;
  for (const PointCloud& sweep : sweeps)
    planes.push_back(*decoder.decode_planes(*encoder.encode(sweep)).front());
  return planes;
}

// Where the planes do not tell, they must say so: along the road of kitti_raw_0001 few do.
TEST(PlaneMotion, IsRightOrRefusedOnRealSweeps) {
  const auto data = real_data_folder();
  if (!data) GTEST_SKIP() << "POINTREEL_DATA is not set";
  constexpr double kWrongM = 0.3;  // GPS and any registration disagree by up to 0.18 m a sweep
  struct Case {
    const char* folder;
    double least_share;  // of the motions that are found at a bound of 10 cm
  };
  for (const auto& [folder, least_share] :
       {Case{"kitti_raw_0005", 1}, Case{"kitti_raw_0001", 0.7}, Case{"kitti_odometry_00", 1}}) {
    const auto paths = expand_inputs(std::vector<std::string>{(*data / folder).string()});
    ASSERT_TRUE(paths);
    std::vector<PointCloud> sweeps;
    for (const auto& path : *paths) sweeps.push_back(*read_cloud(path));
    const auto truth = read_kitti_poses(*data / folder / "poses.txt");
    ASSERT_TRUE(truth);
    for (const double bound_m : {0.02, 0.05, 0.1}) {
      const auto planes = planes_of(sweeps, bound_m);
      std::size_t found = 0;
      for (std::size_t i = 1; i < planes.size(); ++i) {
        const Pose motion = (*truth)[i - 1].inverse() * (*truth)[i];
        for (const auto& guess : {std::optional<Pose>(), std::optional(motion)}) {
          const auto result = register_planes(planes[i - 1], planes[i], guess);
          if (!result) continue;
          ++found;
          EXPECT_LT((result->T_ref_cur.translation() - motion.translation()).norm(), kWrongM)
              << folder << ", sweep " << i << ", bound " << bound_m << (guess ? ", with" : ", without")
              << " a guess";
        }
      }
      if (bound_m == 0.1) {
        EXPECT_GE(static_cast<double>(found), least_share * 2 * static_cast<double>(planes.size() - 1))
            << folder;
      }
    }
  }
}

}  // namespace
}  // namespace pointreel
