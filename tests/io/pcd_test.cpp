#include <liblzf/lzf.h>

#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

// A header of float x, y, z.
std::string header(std::string_view size_lines, std::string_view data = "ascii") {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + std::string(size_lines) +
         "DATA " + std::string(data) + "\n";
}

class PcdFile : public testing::Test {
 protected:
  Result<PointCloud> read(std::string_view bytes) { return read_cloud(folder_.write("a.pcd", bytes)); }

  TemporaryFolder folder_;
};

TEST_F(PcdFile, ReadsOrganisedAsciiWithCommentsAndOddLineEnds) {
  const auto cloud = read(
      "# .PCD v.7\r\nVERSION .7\r\nFIELDS x y z rgb\r\nSIZE 4 4 4 4\r\nTYPE F F F U\r\nWIDTH 2\r\nHEIGHT "
      "2\r\n"
      "VIEWPOINT 0 0 0 1 0 0 0\r\nPOINTS 4\r\nDATA ascii\r\n"
      "1 2 3 4294967295\r\n\r\n nan NaN -nan 0\r\n+1.5 -1e-3\tinf 7\r\n1e-60 0 0 1");
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_EQ(cloud->size(), 4u);
  EXPECT_EQ(cloud->positions[0], (Point3f{1, 2, 3}));
  EXPECT_EQ(cloud->count_non_finite(), 2u);
  EXPECT_EQ(cloud->positions[3], (Point3f{0, 0, 0}));
  EXPECT_EQ(values_of<std::uint32_t>(*cloud, "rgb"), (std::vector<std::uint32_t>{4294967295u, 0, 7, 1}));
}

TEST_F(PcdFile, SkipsPaddingAndSplitsFieldsWithCounts) {
  const std::string fields =
      "FIELDS normal _ z y x _ t\nSIZE 4 1 8 8 8 1 2\nTYPE F U F F F U I\nCOUNT 2 3 1 1 1 5 1\n"
      "WIDTH 2\nHEIGHT 1\n";
  const auto row = [](float n, double x, std::int16_t t) {
    return bytes_of(n, n + 1, '1', '2', '3', 3.0, 2.0, x, '1', '2', '3', '4', '5', t);
  };
  const auto check = [](const Result<PointCloud>& cloud) {
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->positions, (std::vector<Point3f>{{1, 2, 3}, {-1, 2, 3}}));
    ASSERT_EQ(cloud->fields.size(), 3u);
    EXPECT_EQ(values_of<float>(*cloud, "normal_0"), (std::vector<float>{10, 20}));
    EXPECT_EQ(values_of<float>(*cloud, "normal_1"), (std::vector<float>{11, 21}));
    EXPECT_EQ(values_of<std::int16_t>(*cloud, "t"), (std::vector<std::int16_t>{-7, 8}));
  };
  check(read(fields + "DATA binary\n" + row(10, 1, -7) + row(20, -1, 8)));
  check(read(fields + "DATA ascii\n10 11 1 2 3 3 2 1 1 2 3 4 5 -7\n20 21 1 2 3 3 2 -1 1 2 3 4 5 8\n"));

  // Compressed bodies lie field by field; PCL leaves padding out of them, others may not.
  const std::string front = bytes_of(10.f, 11.f, 20.f, 21.f);
  const std::string back = bytes_of(3.0, 3.0, 2.0, 2.0, 1.0, -1.0);
  const std::string t = bytes_of(std::int16_t{-7}, std::int16_t{8});
  for (const std::string& body :
       {front + back + t, front + std::string(6, '_') + back + std::string(10, '_') + t}) {
    std::string packed(1000, '\0');
    packed.resize(lzf_compress(body.data(), static_cast<unsigned>(body.size()), packed.data(), 1000));
    const std::string sizes =
        bytes_of(static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(body.size()));
    check(read(fields + "DATA binary_compressed\n" + sizes + packed));
  }
}

TEST_F(PcdFile, AcceptsZeroPointsInEveryEncoding) {
  for (const auto data : {"ascii", "binary", "binary_compressed"}) {
    const auto cloud = read(header("WIDTH 0\nHEIGHT 1\nPOINTS 0\n", data));
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->size(), 0u);
  }
}

TEST_F(PcdFile, TakesTheCountFromPointsOrFromWidth) {
  EXPECT_EQ(read(header("POINTS 2\n") + "1 2 3\n4 5 6\n")->size(), 2u);
  EXPECT_EQ(read(header("WIDTH 2\n") + "1 2 3\n4 5 6\n")->size(), 2u);
  expect_error(read(header("HEIGHT 1\n")), ErrorCode::corrupt, {"a.pcd", "WIDTH"});
}

TEST_F(PcdFile, RejectsHeadersThatLieAboutTheCount) {
  const std::string rows = "1 2 3\n4 5 6\n";
  expect_error(read(header("WIDTH 2\nHEIGHT 2\nPOINTS 2\n") + rows), ErrorCode::corrupt, {"a.pcd", "line 8"});
  expect_error(read(header("WIDTH 4294967296\nHEIGHT 4294967296\nPOINTS 0\n")), ErrorCode::corrupt,
               {"line 6"});
  expect_error(read(header("POINTS 3\n") + rows), ErrorCode::truncated, {"a.pcd"});
  expect_error(read(header("POINTS 1\n") + rows), ErrorCode::corrupt, {"line 9"});
  expect_error(read(header("POINTS -1\n") + rows), ErrorCode::corrupt, {"line 6"});
  expect_error(read(header("POINTS 99999999999999999999999\n") + rows), ErrorCode::corrupt, {"line 6"});
  for (const auto data : {"ascii", "binary"}) {
    expect_error(read(header("WIDTH 1000000\nHEIGHT 1000000\n", data) + rows), ErrorCode::truncated,
                 {"a.pcd", "byte offset", "1000000000000"});
    expect_error(read(header("POINTS 18446744073709551615\n", data) + rows), ErrorCode::truncated,
                 {"byte offset"});
  }
  expect_error(read(header("POINTS 1\n", "binary") + std::string(24, '\0')), ErrorCode::corrupt,
               {"12 bytes"});
  EXPECT_TRUE(read(header("POINTS 2\n", "binary") + std::string(24, '\0') + "\n"));
}

TEST_F(PcdFile, RejectsDamagedCompressedBodies) {
  const std::string start = header("POINTS 100\n", "binary_compressed");
  const std::string offset = "byte offset " + std::to_string(start.size());
  const auto sizes = [](std::uint32_t compressed, std::uint32_t full) { return bytes_of(compressed, full); };
  expect_error(read(start), ErrorCode::truncated, {offset});
  expect_error(read(start + sizes(20, 1200)), ErrorCode::truncated, {offset});
  expect_error(read(start + sizes(20, 0xffffffffu) + std::string(20, 'x')), ErrorCode::corrupt,
               {offset, "cannot"});
  expect_error(read(start + sizes(20, 1200) + std::string(20, '\xff')), ErrorCode::corrupt, {"damaged"});
  const std::string two_literals("\1ab", 3);
  expect_error(read(start + sizes(3, 2) + two_literals), ErrorCode::corrupt, {"2 bytes", "100 points"});
  expect_error(read(start + sizes(3, 3) + two_literals), ErrorCode::corrupt, {"damaged"});
  expect_error(read(start + sizes(0, 0)), ErrorCode::corrupt, {"100 points"});
}

TEST_F(PcdFile, RejectsBadHeaders) {
  const auto fields = [](std::string_view names, std::string_view sizes, std::string_view types,
                         std::string_view counts) {
    return "FIELDS " + std::string(names) + "\nSIZE " + std::string(sizes) + "\nTYPE " + std::string(types) +
           "\nCOUNT " + std::string(counts) + "\nWIDTH 0\nDATA ascii\n";
  };
  EXPECT_TRUE(read(fields("x y z", "4 4 4", "F F F", "1 1 1")));
  expect_error(read(fields("x y", "4 4", "F F", "1 1")), ErrorCode::unsupported, {"line 1", "'z'"});
  expect_error(read(fields("x y z", "4 4 4", "F F I", "1 1 1")), ErrorCode::unsupported, {"'z'", "float"});
  expect_error(read(fields("x y z x", "4 4 4 4", "F F F F", "1 1 1 1")), ErrorCode::corrupt,
               {"'x'", "twice"});
  expect_error(read(fields("x y z", "4 4", "F F F", "1 1 1")), ErrorCode::corrupt, {"line 2"});
  expect_error(read(fields("x y z", "4 4 4", "F F F", "1 1")), ErrorCode::corrupt, {"line 4"});
  expect_error(read(fields("x y z", "4 4 2", "F F F", "1 1 1")), ErrorCode::unsupported, {"line 3", "'z'"});
  expect_error(read(fields("x y z", "4 4 0", "F F F", "1 1 1")), ErrorCode::corrupt, {"line 2"});
  expect_error(read(fields("x y z a", "4 4 4 1", "F F F U", "1 1 1 0")), ErrorCode::corrupt, {"line 4"});
  expect_error(read(fields("x y z a", "4 4 4 8", "F F F U", "1 1 1 2305843009213693952")),
               ErrorCode::resource_limit, {"line 1"});
  expect_error(read("FIELDS x y z\n"), ErrorCode::truncated, {"DATA"});
  expect_error(read(""), ErrorCode::truncated, {"a.pcd"});
  expect_error(read(std::string(5000, '\x01')), ErrorCode::corrupt, {"line 1", "..."});
  expect_error(read(header("VERSION 0.8\nPOINTS 0\n")), ErrorCode::unsupported, {"0.8"});
  expect_error(read(header("POINTS 0\n", "zipped")), ErrorCode::unsupported, {"zipped"});
}

TEST_F(PcdFile, NamesTheLineOfABadValue) {
  expect_error(read(header("POINTS 2\n") + "1 2 3\n4 5 6x\n"), ErrorCode::corrupt, {"line 9", "'6x'", "'z'"});
  expect_error(read(header("POINTS 2\n") + "1 2 3\n4 5 1e99\n"), ErrorCode::corrupt, {"line 9"});
  expect_error(read(header("POINTS 2\n") + "1 2 3\n4 5 6 7\n"), ErrorCode::corrupt, {"line 9", "4 values"});
  expect_error(read(header("POINTS 2\n") + "100 200 300\n"), ErrorCode::truncated, {"line 8", "1 of 2"});
}

TEST_F(PcdFile, RefusesFieldsThatCouldNotBeReadBack) {
  const auto path = folder_.path() / "out.pcd";
  for (const auto name : {"x", "_", "", "two words", "line\n"}) {
    const PointCloud cloud{{{1, 2, 3}}, {{name, std::vector<float>{1}}}};
    expect_error(write_cloud(path, cloud, CloudFormat::pcd), ErrorCode::invalid_argument, {"out.pcd"});
  }
  const PointCloud wrong_size{{{1, 2, 3}}, {{"a", std::vector<float>{1, 2}}}};
  expect_error(write_cloud(path, wrong_size, CloudFormat::pcd), ErrorCode::invalid_argument,
               {"'a'", "2 values"});
  const PointCloud twice{{}, {{"a", std::vector<float>{}}, {"a", std::vector<float>{}}}};
  expect_error(write_cloud(path, twice, CloudFormat::pcd), ErrorCode::invalid_argument, {"'a'"});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace pointreel
