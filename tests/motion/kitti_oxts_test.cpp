#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "pointreel/motion.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;
using Vec3 = Eigen::Vector3d;

struct Reading {
  double roll_rad = 0, pitch_rad = 0;
  Vec3 velocity_level_mps = Vec3::Zero(), acceleration_mps2 = Vec3::Zero(), rate_radps = Vec3::Zero();
};

std::string to_line(const Reading& reading) {
  std::array<double, 30> values{};
  values.fill(77);  // what the reader has to leave alone
  values[3] = reading.roll_rad;
  values[4] = reading.pitch_rad;
  std::copy_n(reading.velocity_level_mps.data(), 3, &values[8]);
  std::copy_n(reading.acceleration_mps2.data(), 3, &values[11]);
  std::copy_n(reading.rate_radps.data(), 3, &values[17]);
  std::ostringstream line;
  line.precision(17);
  for (const double value : values) line << value << ' ';
  return line.str();
}

constexpr const char* kTimes =
    "2011-09-26 23:59:59.964389445\n"
    "2011-09-27 00:00:00.064389445\n"
    "2011-09-27 00:00:00.164389446\n";

// drive/oxts with three samples, as KITTI lays it out below the day's calibration files.
struct Drive {
  Drive() {
    folder.write("day/drive/oxts/timestamps.txt", kTimes);
    for (const char* name : {"0000000000", "0000000001", "0000000002"}) set_data(name, to_line({}));
  }
  fs::path oxts() const { return folder.path() / "day/drive/oxts"; }
  void set_data(const std::string& name, const std::string& text) const {
    folder.write("day/drive/oxts/data/" + name + ".txt", text);
  }
  TemporaryFolder folder;
};

TEST(KittiOxts, TimesCountFromTheFirstSampleAcrossMidnight) {
  const Drive drive;
  const auto samples = read_kitti_oxts(drive.oxts());
  ASSERT_TRUE(samples) << samples.error().message;
  ASSERT_EQ(samples->size(), 3u);
  EXPECT_EQ((*samples)[0].time_s, 0);
  EXPECT_NEAR((*samples)[1].time_s, 0.1, 1e-12);
  EXPECT_NEAR((*samples)[2].time_s, 0.200000001, 1e-12);
}

TEST(KittiOxts, WithoutCalibrationTheVehicleAxesStay) {
  const Drive drive;
  Reading reading;
  reading.velocity_level_mps = Vec3(1, 2, 3);
  reading.acceleration_mps2 = Vec3(4, 5, 6);
  reading.rate_radps = Vec3(7, 8, 9);
  drive.set_data("0000000001", to_line(reading));
  const auto samples = read_kitti_oxts(drive.oxts());
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_EQ((*samples)[1].velocity_mps, reading.velocity_level_mps);
  EXPECT_EQ((*samples)[1].acceleration_mps2, reading.acceleration_mps2);
  EXPECT_EQ((*samples)[1].rotation_rate_radps, reading.rate_radps);
}

TEST(KittiOxts, LevelledVelocityIsTiltedIntoTheVehicle) {
  const Drive drive;
  Reading uphill;  // positive pitch is front down
  uphill.pitch_rad = -0.1;
  uphill.velocity_level_mps = Vec3(10 * std::cos(0.1), 0, 10 * std::sin(0.1));
  drive.set_data("0000000000", to_line(uphill));
  Reading left_side_up;
  left_side_up.roll_rad = 0.1;
  left_side_up.velocity_level_mps = Vec3(0, std::cos(0.1), std::sin(0.1));
  drive.set_data("0000000001", to_line(left_side_up));
  const auto samples = read_kitti_oxts(drive.oxts());
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_TRUE((*samples)[0].velocity_mps->isApprox(Vec3(10, 0, 0), 1e-12));
  EXPECT_TRUE((*samples)[1].velocity_mps->isApprox(Vec3(0, 1, 0), 1e-12));
}

TEST(KittiOxts, CalibrationTurnsAxesAndAddsTheLever) {
  // The LiDAR looks to the left of the vehicle and sits 2 m in front of the IMU.
  const std::string calibration = "calib_time: 25-May-2012 16:47:16\nR: 0 1 0 -1 0 0 0 0 1\nT: 0 2 0\n";
  for (const char* place : {"day/drive", "day", "."}) {
    const Drive drive;
    drive.folder.write(fs::path(place) / "calib_imu_to_velo.txt", calibration);
    Reading reading;
    reading.velocity_level_mps = Vec3(10, 0, 0);
    reading.acceleration_mps2 = Vec3(1, 0, 9.81);
    reading.rate_radps = Vec3(0, 0, 0.5);
    drive.set_data("0000000000", to_line(reading));
    const auto samples = read_kitti_oxts(drive.oxts() / "");
    ASSERT_TRUE(samples) << samples.error().message;
    const ImuSample& sample = samples->front();
    EXPECT_TRUE(sample.acceleration_mps2.isApprox(Vec3(0, -1, 9.81))) << place;
    EXPECT_TRUE(sample.rotation_rate_radps.isApprox(Vec3(0, 0, 0.5))) << place;
    // Turning left, the nose also moves left (1 m/s), which is the LiDAR's forward.
    EXPECT_TRUE(sample.velocity_mps->isApprox(Vec3(1, -10, 0))) << place << sample.velocity_mps->transpose();
  }
}

TEST(KittiOxts, MissingFilesLeaveTheOthersTheirTimes) {
  const Drive drive;
  fs::remove(drive.oxts() / "data/0000000000.txt");
  fs::remove(drive.oxts() / "data/0000000001.txt");
  drive.set_data("0000000000", to_line({}));
  const auto samples = read_kitti_oxts(drive.oxts());
  ASSERT_TRUE(samples) << samples.error().message;
  ASSERT_EQ(samples->size(), 2u);
  EXPECT_NEAR((*samples)[1].time_s, 0.200000001, 1e-12);
}

TEST(KittiOxts, RejectsMalformedFolders) {
  const struct {
    const char* file;
    std::string text;
    ErrorCode code;
    const char* complaint;
  } cases[] = {
      {"drive/oxts/timestamps.txt", "", ErrorCode::truncated, "timestamps.txt: holds no times"},
      {"drive/oxts/timestamps.txt", "1.5\n", ErrorCode::corrupt, "timestamps.txt:1: is no time"},
      {"drive/oxts/timestamps.txt", "2011-02-30 00:00:00.1\n", ErrorCode::corrupt,
       "timestamps.txt:1: is no time"},
      {"drive/oxts/timestamps.txt", "2011-09-26 24:00:00.1\n", ErrorCode::corrupt,
       "timestamps.txt:1: is no time"},
      {"drive/oxts/timestamps.txt", "2011-09-26 13:00:00,1\n", ErrorCode::corrupt,
       "timestamps.txt:1: is no time"},
      {"drive/oxts/timestamps.txt", "2011-09-26 13:00\n", ErrorCode::corrupt, "timestamps.txt:1: is no time"},
      {"drive/oxts/timestamps.txt", "2011-09-26 13:00:01\n2011-09-26 13:00:00\n", ErrorCode::corrupt,
       "timestamps.txt:2: the time is not after"},
      {"drive/oxts/timestamps.txt", "2011-09-26 13:00:01\n", ErrorCode::corrupt,
       "timestamps.txt:2: no time for"},
      {"drive/oxts/data/0000000001.txt", "", ErrorCode::truncated, "0000000001.txt: holds no values"},
      {"drive/oxts/data/0000000001.txt", "1 2 3\n", ErrorCode::corrupt,
       "0000000001.txt:1: has 3 numbers where 30"},
      {"drive/oxts/data/0000000001.txt", to_line({}) + "\n" + to_line({}), ErrorCode::corrupt,
       "0000000001.txt:2: a second line"},
      {"drive/oxts/data/1.txt", to_line({}), ErrorCode::corrupt, "1.txt: has the number of"},
      {"drive/oxts/data/notes.txt", "", ErrorCode::corrupt, "notes.txt: is not named by a number"},
      {"calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\n", ErrorCode::corrupt, "lacks a line R: or T:"},
      {"calib_imu_to_velo.txt", "R: 1 0 0\nT: 0 0 0\n", ErrorCode::corrupt,
       "velo.txt:1: has 3 numbers where 9"},
      {"calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 5\nT: 0 0 0\n", ErrorCode::corrupt, "is not a rotation"},
  };
  for (const auto& [file, text, code, complaint] : cases) {
    const Drive drive;
    drive.folder.write(fs::path("day") / file, text);
    expect_error(read_kitti_oxts(drive.oxts()), code, complaint);
  }
}

TEST(KittiOxts, RejectsMissingParts) {
  const TemporaryFolder folder;
  expect_error(read_kitti_oxts(folder.path()), ErrorCode::io_error, "timestamps.txt");
  folder.write("timestamps.txt", kTimes);
  expect_error(read_kitti_oxts(folder.path()), ErrorCode::io_error, "data: cannot be listed");
  fs::create_directory(folder.path() / "data");
  expect_error(read_kitti_oxts(folder.path()), ErrorCode::truncated, "holds no .txt files");
}

}  // namespace
}  // namespace pointreel
