#include <gtest/gtest.h>

#include <cstdlib>

#include "pointreel/motion.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

Pose make_pose(double x, double y, double z, double yaw_rad) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d(0.1, -0.2, 1).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

TEST(KittiPoses, ComeBackAsWritten) {
  const TemporaryFolder folder;
  const std::vector<Pose> written{make_pose(0, 0, 0, 0), make_pose(1.0 / 3, -2e6, 1e-17, 2.5)};
  ASSERT_TRUE(write_kitti_poses(folder.path() / "poses.txt", written));
  const auto read = read_kitti_poses(folder.path() / "poses.txt");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), written.size());
  for (std::size_t k = 0; k < written.size(); ++k) {
    EXPECT_EQ((*read)[k].translation(), written[k].translation());
    EXPECT_TRUE((*read)[k].linear().isApprox(written[k].linear(), 1e-15));
  }
}

TEST(KittiPoses, ReadTheUsualVariations) {
  const TemporaryFolder folder;
  const auto path = folder.write("poses.txt",
                                 "\xEF\xBB\xBF# a comment\r\n\r\n"
                                 "  1.0e+00 0 0 +5 \t 0 1 0 -6 0 0 1 7\r\n" +
                                     std::string("1 0 0 0 0 1 0 0 0 0 1 0"));
  const auto poses = read_kitti_poses(path);
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->size(), 2u);
  EXPECT_EQ((*poses)[0].translation(), Eigen::Vector3d(5, -6, 7));
}

TEST(KittiPoses, RoundedMatricesBecomeRotations) {
  const TemporaryFolder folder;
  const auto poses = read_kitti_poses(folder.write("poses.txt", "0.866 -0.5 0 1 0.5 0.866 0 2 0 0 1 3\n"));
  ASSERT_TRUE(poses) << poses.error().message;
  const Eigen::Matrix3d R = poses->front().linear();
  EXPECT_TRUE((R.transpose() * R).isIdentity(1e-14));
  EXPECT_NEAR(R.determinant(), 1, 1e-14);
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), M_PI / 6, 1e-4);
}

TEST(KittiPoses, RejectWhatIsNoPose) {
  const TemporaryFolder folder;
  const struct {
    const char* line;
    const char* complaint;
  } cases[] = {
      {"1 0 0 0 0 1 0 0 0 0 1\n", "poses.txt:2: has 11 numbers where 12 are needed"},
      {"1 0 0 0 0 1 0 0 0 0 1 0 0\n", "poses.txt:2: has 13 numbers"},
      {"1 0 0 x 0 1 0 0 0 0 1 0\n", "poses.txt:2: x is not a finite number"},
      {"1 0 0 1.5.2 0 1 0 0 0 0 1 0\n", "poses.txt:2: 1.5.2"},
      {"1 0 0 nan 0 1 0 0 0 0 1 0\n", "poses.txt:2: nan"},
      {"1 0 0 1e999 0 1 0 0 0 0 1 0\n", "poses.txt:2: 1e999"},
      {"1 0 0 +-1 0 1 0 0 0 0 1 0\n", "poses.txt:2: +-1"},
      {"2 0 0 0 0 1 0 0 0 0 1 0\n", "poses.txt:2: the left 3x3 of the matrix is not a rotation"},
      {"0 0 0 0 0 0 0 0 0 0 0 0\n", "not a rotation"},
      {"1 0 0 0 0 1 0 0 0 0 -1 0\n", "not a rotation"},  // a mirror
      {"1e300 0 0 0 0 1e300 0 0 0 0 1e300 0\n", "not a rotation"},
      {"1 0 0.1 0 0 1 0 0 0 0 1 0\n", "not a rotation"},  // sheared
  };
  for (const auto& [line, complaint] : cases) {
    const auto path = folder.write("poses.txt", kIdentity + std::string(line));
    expect_error(read_kitti_poses(path), ErrorCode::corrupt, complaint);
  }
}

TEST(KittiPoses, RejectUnreadableFiles) {
  const TemporaryFolder folder;
  expect_error(read_kitti_poses(folder.path() / "none.txt"), ErrorCode::io_error, "none.txt");
  expect_error(read_kitti_poses(folder.path()), ErrorCode::io_error, folder.path().string());
  expect_error(read_kitti_poses(folder.write("empty.txt", "")), ErrorCode::truncated, "empty.txt");
  expect_error(read_kitti_poses(folder.write("comment.txt", "# none\n")), ErrorCode::truncated,
               "comment.txt");
  expect_error(read_kitti_poses(folder.write("binary", std::string(1 << 20, '\1'))), ErrorCode::corrupt,
               "binary:1: the line is longer");
  expect_error(read_kitti_poses(folder.write("nul", kIdentity + std::string("1 0\0 0", 6))),
               ErrorCode::corrupt, "nul:2:");
}

TEST(KittiPoses, FailedWritesSaySoAndLeaveNothing) {
  const TemporaryFolder folder;
  const std::vector<Pose> poses(1, Pose::Identity());
  expect_error(write_kitti_poses(folder.path() / "no_such_folder" / "poses.txt", poses), ErrorCode::io_error,
               "poses.txt");
  fs::create_directories(folder.path() / "taken" / "by_a_folder");
  expect_error(write_kitti_poses(folder.path() / "taken", poses), ErrorCode::io_error, "taken");
  EXPECT_FALSE(fs::exists(folder.path() / "taken.partial"));
}

TEST(TumPoses, AreReadWithTheirTimes) {
  const TemporaryFolder folder;
  const auto poses = read_tum_poses(folder.write("tum.txt",
                                                 "# time tx ty tz qx qy qz qw\n"
                                                 "1305031102.1758 1 2 3 0 0 0 1\n"
                                                 "1305031102.2758 4 5 6 0 0 0.7071 0.7071\n"));
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->size(), 2u);
  EXPECT_EQ((*poses)[0].time_s, 1305031102.1758);
  EXPECT_TRUE((*poses)[0].T_world_sensor.linear().isIdentity());
  const Pose& turned = (*poses)[1].T_world_sensor;
  EXPECT_EQ(turned.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE((turned.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST(TumPoses, RejectWhatIsNoPose) {
  const TemporaryFolder folder;
  const struct {
    const char* line;
    const char* complaint;
  } cases[] = {
      {"2 0 0 0 0 0 1\n", "tum.txt:2: has 7 numbers where 8 are needed"},
      {"2 0 0 0 0 0 0 0\n", "tum.txt:2: the quaternion is not of length 1"},
      {"2 0 0 0 0 0 1 1\n", "tum.txt:2: the quaternion"},
      {"2 0 0 0 0 0 inf 1\n", "tum.txt:2: inf"},
      {"1 0 0 0 0 0 0 1\n", "tum.txt:2: the time is not after"},
      {"0.5 0 0 0 0 0 0 1\n", "tum.txt:2: the time is not after"},
  };
  for (const auto& [line, complaint] : cases) {
    const auto path = folder.write("tum.txt", "1 0 0 0 0 0 0 1\n" + std::string(line));
    expect_error(read_tum_poses(path), ErrorCode::corrupt, complaint);
  }
  expect_error(read_tum_poses(folder.write("tum.txt", "\n")), ErrorCode::truncated, "holds no poses");
}

TEST(KittiPoses, OfRealDrivesAreOneASweep) {
  const char* const data = std::getenv("POINTREEL_DATA");
  if (data == nullptr) GTEST_SKIP() << "POINTREEL_DATA is not set";
  const std::pair<const char*, std::size_t> sets[] = {
      {"kitti_raw_0005", 30}, {"kitti_raw_0001", 10}, {"kitti_odometry_00", 6}};
  for (const auto& [set, sweeps] : sets) {
    const auto poses = read_kitti_poses(fs::path(data) / set / "poses.txt");
    ASSERT_TRUE(poses) << poses.error().message;
    EXPECT_EQ(poses->size(), sweeps) << set;
    EXPECT_TRUE(poses->front().isApprox(Pose::Identity(), 1e-6)) << set;
  }
}

}  // namespace
}  // namespace pointreel
