#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pointreel/motion.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace pointreel {
namespace {

Eigen::Vector3d arbitrary_vector() {
  const auto component = rc::gen::arbitrary<double>();
  return {*component, *component, *component};
}

void expect_same(const ImuSample& a, const ImuSample& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.acceleration_mps2, b.acceleration_mps2);
  EXPECT_EQ(a.rotation_rate_radps, b.rotation_rate_radps);
  EXPECT_EQ(a.velocity_mps, b.velocity_mps);
}

RC_GTEST_PROP(ImuCsv, ComesBackAsWritten, ()) {
  const bool with_velocity = *rc::gen::arbitrary<bool>();
  std::vector<ImuSample> written(static_cast<std::size_t>(*rc::gen::inRange(1, 20)));
  double time_s = *rc::gen::inRange(-1000, 1000) / 7.0;
  for (ImuSample& sample : written) {
    sample.time_s = time_s += *rc::gen::inRange(1, 1000) / 999.0;
    sample.acceleration_mps2 = arbitrary_vector();
    sample.rotation_rate_radps = arbitrary_vector();
    if (with_velocity) sample.velocity_mps = arbitrary_vector();
  }
  const TemporaryFolder folder;
  RC_ASSERT(static_cast<bool>(write_imu_csv(folder.path() / "imu.csv", written)));
  const auto read = read_imu_csv(folder.path() / "imu.csv");
  RC_ASSERT(static_cast<bool>(read));
  RC_ASSERT(read->size() == written.size());
  for (std::size_t k = 0; k < written.size(); ++k) expect_same((*read)[k], written[k]);
}

TEST(ImuCsv, HeaderCommentsAndBlanksAreOptional) {
  const TemporaryFolder folder;
  const auto samples = read_imu_csv(folder.write("imu.csv",
                                                 "# made by hand\n"
                                                 "time [s], acc x, acc y, acc z, gyro x, gyro y, gyro z\r\n"
                                                 "0, 1, 2, 3, 4, 5, 6\r\n"
                                                 "# in between\n"
                                                 "0.01,\t1,2,3,4,5,-6.5e-1\n"));
  ASSERT_TRUE(samples) << samples.error().message;
  ASSERT_EQ(samples->size(), 2u);
  EXPECT_EQ((*samples)[0].acceleration_mps2, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ((*samples)[1].rotation_rate_radps, Eigen::Vector3d(4, 5, -0.65));
  EXPECT_FALSE((*samples)[0].velocity_mps);

  const auto bare = read_imu_csv(folder.write("bare.csv", "0,1,2,3,4,5,6,7,8,9\n"));
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_EQ(bare->front().velocity_mps, Eigen::Vector3d(7, 8, 9));
}

TEST(ImuCsv, RejectsMalformedFiles) {
  const TemporaryFolder folder;
  const struct {
    const char* text;
    const char* complaint;
  } cases[] = {
      {"0,1,2,3,4,5\n", "imu.csv:1: has 6 columns where 7 or 10 are needed"},
      {"0,1,2,3,4,5,6,7\n", "imu.csv:1: has 8 columns"},
      {"0,1,2,3,4,5,6\n0.1,1,2,3,,5,6\n", "imu.csv:2:  is not a finite number"},
      {"0,1,2,3,4,5,6\nt,ax,ay,az,wx,wy,wz\n", "imu.csv:2: t is not"},
      {"0,1,2,3,4,5,6\n0.1,1,2,3,4,5,nan\n", "imu.csv:2: nan"},
      {"0,1,2,3,4,5,6\n0.1 1 2 3 4 5 6\n", "imu.csv:2: 0.1 1 2"},
      {"0.1,1,2,3,4,5,6\n0.1,1,2,3,4,5,6\n", "imu.csv:2: the time is not after"},
      {"t,wx,wy,wz,ax,ay,az\n0,1,2,3,4,5,6\n", "imu.csv:1: column wx"},
  };
  for (const auto& [text, complaint] : cases) {
    expect_error(read_imu_csv(folder.write("imu.csv", text)), ErrorCode::corrupt, complaint);
  }
  expect_error(read_imu_csv(folder.write("imu.csv", "t,ax,ay,az,wx,wy,wz\n")), ErrorCode::truncated,
               "holds no IMU samples");
  expect_error(read_imu_csv(folder.path() / "none.csv"), ErrorCode::io_error, "none.csv");
}

}  // namespace
}  // namespace pointreel
