#include <limits>

#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

class KittiFile : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(KittiFile, ReadsPositionsAndIntensity) {
  const auto path = folder_.write("a.bin", bytes_of(1.f, 2.f, 3.f, 0.5f, -4.f, 5.f, 6.f, 0.25f));
  const auto cloud = read_cloud(path);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->positions, (std::vector<Point3f>{{1, 2, 3}, {-4, 5, 6}}));
  EXPECT_EQ(values_of<float>(*cloud, "intensity"), (std::vector<float>{0.5f, 0.25f}));
}

TEST_F(KittiFile, AnEmptyFileIsACloudWithoutPoints) {
  for (const auto name : {"empty.bin", "empty.pcd.bin"}) {
    const auto cloud = read_cloud(folder_.write(name, ""));
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->size(), 0u);
    EXPECT_EQ(values_of<float>(*cloud, "intensity").size(), 0u);
  }
}

TEST_F(KittiFile, ReadsNuScenesByNameAndBySize) {
  const std::string bytes = bytes_of(1.f, 2.f, 3.f, 77.f, 31.f);
  for (const auto name : {"a.pcd.bin", "A.PCD.BIN", "a.bin"}) {
    const auto cloud = read_cloud(folder_.write(name, bytes));
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->positions, (std::vector<Point3f>{{1, 2, 3}}));
    EXPECT_EQ(values_of<float>(*cloud, "intensity"), std::vector<float>{77});
    EXPECT_EQ(values_of<float>(*cloud, "ring"), std::vector<float>{31});
  }
  expect_error(read_cloud(folder_.path() / "a.bin", CloudFormat::kitti), ErrorCode::truncated,
               {"a.bin", "offset 16"});
}

TEST_F(KittiFile, NamesTheOffsetOfAPointCutShort) {
  const auto path = folder_.write("cut.bin", std::string(16 * 3 + 7, '\0'));
  expect_error(read_cloud(path), ErrorCode::truncated, {"cut.bin", "offset 48", "7 of"});
}

TEST_F(KittiFile, WritesMissingFieldsAsZeroAndConvertsOthers) {
  const PointCloud cloud{{{1, 2, 3}},
                         {{"ring", std::vector<std::uint16_t>{9}}, {"t", std::vector<double>{1}}}};
  const auto path = folder_.path() / "out.bin";
  ASSERT_TRUE(write_cloud(path, cloud, CloudFormat::kitti));
  EXPECT_EQ(file_bytes(path), bytes_of(1.f, 2.f, 3.f, 0.f));
  ASSERT_TRUE(write_cloud(path, cloud, CloudFormat::nuscenes));
  EXPECT_EQ(file_bytes(path), bytes_of(1.f, 2.f, 3.f, 0.f, 9.f));
}

TEST_F(KittiFile, KeepsEveryBitOfNonFinitePoints) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const PointCloud cloud{{{nan, -nan, inf}, {0, -0.f, -inf}}, {{"intensity", std::vector<float>{nan, 1}}}};
  const auto path = folder_.path() / "nan.bin";
  ASSERT_TRUE(write_cloud(path, cloud, CloudFormat::kitti));
  const auto again = read_cloud(path);
  ASSERT_TRUE(again);
  EXPECT_TRUE(same_cloud(cloud, *again));
}

TEST_F(KittiFile, HasNoAsciiEncoding) {
  expect_error(write_cloud(folder_.path() / "a.bin", {}, CloudFormat::kitti, CloudEncoding::ascii),
               ErrorCode::invalid_argument, {"a.bin", "binary"});
}

TEST(CloudFormatName, IsGuessedFromTheFileName) {
  EXPECT_EQ(*guess_cloud_format("x/000000.bin"), CloudFormat::kitti);
  EXPECT_EQ(*guess_cloud_format("x.PCD.bin"), CloudFormat::nuscenes);
  EXPECT_EQ(*guess_cloud_format("x.Pcd"), CloudFormat::pcd);
  EXPECT_EQ(*guess_cloud_format("x.y.ply"), CloudFormat::ply);
  expect_error(guess_cloud_format("x.txt"), ErrorCode::unsupported, {"x.txt"});
  expect_error(guess_cloud_format("bin"), ErrorCode::unsupported, {"bin"});
}

TEST(CloudFormatName, IsParsedAndPrinted) {
  for (const auto format : {CloudFormat::kitti, CloudFormat::nuscenes, CloudFormat::pcd, CloudFormat::ply}) {
    EXPECT_EQ(*parse_cloud_format(to_string(format)), format);
    EXPECT_EQ(*guess_cloud_format(std::string("a").append(file_extension(format))), format);
  }
  expect_error(parse_cloud_format("las"), ErrorCode::invalid_argument, {"las"});
}

}  // namespace
}  // namespace pointreel
