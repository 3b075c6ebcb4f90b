#include <algorithm>
#include <initializer_list>

#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;

class Inputs : public testing::Test {
 protected:
  Result<std::vector<fs::path>> expand(std::initializer_list<std::string_view> names) {
    std::vector<std::string> arguments;
    for (const auto name : names) arguments.push_back((folder_.path() / name).string());
    return expand_inputs(arguments);
  }

  void expect_files(std::initializer_list<std::string_view> arguments, std::vector<std::string> expected) {
    const auto paths = expand(arguments);
    ASSERT_TRUE(paths) << paths.error().message;
    std::vector<std::string> names;
    for (const auto& path : *paths) names.push_back(path.lexically_relative(folder_.path()).string());
    EXPECT_EQ(names, expected);
  }

  TemporaryFolder folder_;
};

TEST_F(Inputs, FolderGivesItsCloudFilesInNaturalOrder) {
  for (const auto name :
       {"10.bin", "2.bin", "1.ply", "003.PCD", "4.pcd.bin", "poses.txt", ".5.bin", "sub/6.bin"}) {
    folder_.write(name, "");
  }
  fs::create_directory(folder_.path() / "7.bin");
  expect_files({""}, {"1.ply", "2.bin", "003.PCD", "4.pcd.bin", "10.bin"});
}

TEST_F(Inputs, FolderWithoutCloudFilesGivesThoseOfItsSweepFolder) {
  folder_.write("a/velodyne/1.bin", "");
  folder_.write("a/data/2.bin", "");
  folder_.write("a/poses.txt", "");
  folder_.write("b/velodyne_points/data/1.bin", "");
  folder_.write("b/velodyne_points/timestamps.txt", "");
  folder_.write("c/data/1.bin", "");
  expect_files({"c", "b", "a"}, {"c/data/1.bin", "b/velodyne_points/data/1.bin", "a/velodyne/1.bin"});
}

TEST_F(Inputs, PatternGivesItsFilesInNaturalOrder) {
  for (const auto name : {"a10.bin", "a9.bin", "b1.bin", "a9.txt"}) folder_.write(name, "");
  fs::create_directory(folder_.path() / "a1.bin");
  expect_files({"*.bin"}, {"a9.bin", "a10.bin", "b1.bin"});
  expect_files({"[b-c]?.bin", "a?.*"}, {"b1.bin", "a9.bin", "a9.txt"});
}

TEST_F(Inputs, FileIsTakenAsItIs) {
  for (const auto name : {"x.xyz", "[1].bin", "1.bin"}) folder_.write(name, "");
  expect_files({"x.xyz", "[1].bin"}, {"x.xyz", "[1].bin"});
}

TEST_F(Inputs, NamesTheArgumentThatMatchesNothing) {
  folder_.write("1.bin", "");
  fs::create_directory(folder_.path() / "empty");
  expect_error(expand({"1.bin", "none.bin"}), ErrorCode::invalid_argument, {"none.bin"});
  expect_error(expand({"none*.bin"}), ErrorCode::invalid_argument, {"none*.bin"});
  expect_error(expand({"empty"}), ErrorCode::invalid_argument, {"empty", "velodyne"});
  EXPECT_FALSE(expand_inputs(std::vector<std::string>{""}));
  EXPECT_TRUE(expand_inputs({})->empty());
}

TEST(NaturalLess, ComparesDigitRunsAsNumbers) {
  const std::vector<std::string> sorted = {"",     "0",     "1.bin",   "2.bin",
                                           "010",  "10",    "a",       "a-1",
                                           "a1b2", "a1b10", "a00002b", "a123456789012345678901234567890"};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      EXPECT_EQ(natural_less(sorted[i], sorted[k]), i < k) << sorted[i] << " and " << sorted[k];
    }
  }
}

}  // namespace
}  // namespace pointreel
