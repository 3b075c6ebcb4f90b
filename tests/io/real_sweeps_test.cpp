// Real sweeps from $POINTREEL_DATA, which are not part of the repository.
#include <cstdlib>

#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;

class RealSweeps : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("POINTREEL_DATA");
    if (folder == nullptr) GTEST_SKIP() << "POINTREEL_DATA is not set";
    data_ = folder;
  }

  std::vector<fs::path> sweeps(std::string_view name) {
    const auto paths = expand_inputs(std::vector<std::string>{(data_ / name).string()});
    EXPECT_TRUE(paths) << paths.error().message;
    return paths ? *paths : std::vector<fs::path>{};
  }

  fs::path data_;
};

TEST_F(RealSweeps, KittiFilesHaveSixteenBytesAPoint) {
  for (const auto& [name, count] :
       {std::pair("kitti_raw_0005", 30u), {"kitti_raw_0001", 10u}, {"kitti_odometry_00", 6u}}) {
    const auto paths = sweeps(name);
    EXPECT_EQ(paths.size(), count);
    for (const auto& path : paths) {
      const auto cloud = read_cloud(path);
      ASSERT_TRUE(cloud) << cloud.error().message;
      EXPECT_EQ(cloud->size() * 16, fs::file_size(path));
      EXPECT_EQ(cloud->count_non_finite(), 0u);
      EXPECT_GT(cloud->size(), 100'000u);
    }
  }
}

TEST_F(RealSweeps, CompressedPcdSurvivesRewriting) {
  const auto paths = sweeps("ring_time_pcd");
  EXPECT_EQ(paths.size(), 5u);
  const TemporaryFolder folder;
  for (const auto& path : paths) {
    const auto cloud = read_cloud(path);
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_GT(cloud->size(), 80'000u);
    EXPECT_EQ(values_of<float>(*cloud, "intensity").size(), cloud->size());
    EXPECT_EQ(values_of<std::uint16_t>(*cloud, "ring").size(), cloud->size());
    EXPECT_EQ(values_of<double>(*cloud, "timestamp").size(), cloud->size());
    for (const auto encoding :
         {CloudEncoding::ascii, CloudEncoding::binary, CloudEncoding::binary_compressed}) {
      const auto copy = folder.path() / "copy.pcd";
      ASSERT_TRUE(write_cloud(copy, *cloud, CloudFormat::pcd, encoding));
      const auto again = read_cloud(copy);
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_TRUE(same_cloud(*cloud, *again));
    }
  }
  EXPECT_EQ(read_cloud(paths.front())->size(), 80'787u);
}

}  // namespace
}  // namespace pointreel
