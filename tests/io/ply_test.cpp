#include <algorithm>

#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

constexpr std::string_view vertex_header = "property float x\nproperty float y\nproperty float z\n";

class PlyFile : public testing::Test {
 protected:
  Result<PointCloud> read(std::string_view bytes) { return read_cloud(folder_.write("a.ply", bytes)); }

  TemporaryFolder folder_;
};

// A scene with elements before and after the vertices, with lists and without.
std::string scene_header(std::string_view format) {
  return "ply\nformat " + std::string(format) +
         " 1.0\ncomment a scene\nobj_info made by hand\n"
         "element material 2\nproperty list uchar int indices\nproperty double gloss\n"
         "element camera 1\nproperty short id\n"
         "element vertex 2\nproperty uint8 red\nproperty double x\nproperty float32 y\nproperty float z\n"
         "property int16 ring\n"
         "element face 2\nproperty list int32 uint corners\n"
         "end_header\n";
}

void expect_scene(const Result<PointCloud>& cloud) {
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->positions, (std::vector<Point3f>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(values_of<std::uint8_t>(*cloud, "red"), (std::vector<std::uint8_t>{255, 7}));
  EXPECT_EQ(values_of<std::int16_t>(*cloud, "ring"), (std::vector<std::int16_t>{-2, 300}));
}

template <class... T>
std::string big_endian(T... values) {
  std::string bytes;
  const auto append = [&](std::string value) { bytes.append(value.rbegin(), value.rend()); };
  (append(bytes_of(values)), ...);
  return bytes;
}

TEST_F(PlyFile, ReadsAsciiBesideOtherElements) {
  expect_scene(read(scene_header("ascii") + "3 1 2 3 0.5\n0 0.25\n-1\n255 1 2 3 -2\n7 4 5 6 300\n1 0\n0\n"));
}

TEST_F(PlyFile, ReadsBothByteOrdersBesideOtherElements) {
  const auto body = [](auto encode) {
    using U8 = std::uint8_t;
    using I16 = std::int16_t;
    return encode(U8{3}, 1, 2, 3, 0.5, U8{0}, 0.25, I16{-1}, U8{255}, 1.0, 2.f, 3.f, I16{-2}, U8{7}, 4.0, 5.f,
                  6.f, I16{300}, 1, 0u, 0);
  };
  expect_scene(read(scene_header("binary_little_endian") + body([](auto... v) { return bytes_of(v...); })));
  expect_scene(read(scene_header("binary_big_endian") + body([](auto... v) { return big_endian(v...); })));
}

TEST_F(PlyFile, AcceptsZeroPoints) {
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const auto cloud = read("ply\nformat " + format + " 1.0\nelement vertex 0\n" +
                            std::string(vertex_header) + "end_header\n");
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->size(), 0u);
  }
}

TEST_F(PlyFile, RejectsCountsThatTheFileCannotHold) {
  const auto file = [](std::string_view format, std::string_view elements, std::string_view body) {
    return "ply\nformat " + std::string(format) + " 1.0\n" + std::string(elements) + "end_header\n" +
           std::string(body);
  };
  const std::string few_points = "element vertex 1\n" + std::string(vertex_header);
  const std::string many_points = "element vertex 1000000000000\n" + std::string(vertex_header);
  const std::string binary = "binary_little_endian";
  expect_error(read(file("ascii", many_points, "1 2 3\n")), ErrorCode::truncated, {"a.ply", "byte offset"});
  expect_error(read(file(binary, many_points, "1 2 3\n")), ErrorCode::truncated, {"a.ply", "byte offset"});
  expect_error(read(file("ascii", few_points, "1 2 3\n4 5 6\n")), ErrorCode::corrupt, {"line 9"});
  expect_error(read(file(binary, few_points, std::string(24, '\0'))), ErrorCode::corrupt, {"too few"});
  const std::string lists = "element face 1000000000000\nproperty list int uchar corners\n";
  expect_error(read(file("ascii", few_points + lists, "1 2 3\n0\n")), ErrorCode::truncated, {"'face'"});
  expect_error(read(file(binary, few_points + lists, std::string(16, '\0'))), ErrorCode::truncated,
               {"'face'"});
  const std::string negative_length =
      file(binary, few_points + lists, std::string(12, '\0') + bytes_of(std::int32_t{-1}));
  expect_error(read(negative_length), ErrorCode::truncated,
               {"offset " + std::to_string(negative_length.size() - sizeof(std::int32_t)), "'face'"});
  const std::string nothing = "element nothing 18446744073709551615\n";
  EXPECT_TRUE(read(file("ascii", nothing + few_points, "1 2 3\n")));
  EXPECT_TRUE(read(file(binary, nothing + few_points, std::string(12, '\0'))));
}

TEST_F(PlyFile, RejectsBadHeaders) {
  const auto header = [](std::string_view lines) {
    return "ply\nformat ascii 1.0\n" + std::string(lines) + "end_header\n";
  };
  const std::string vertex = "element vertex 0\n" + std::string(vertex_header);
  EXPECT_TRUE(read(header(vertex)));
  expect_error(read(""), ErrorCode::corrupt, {"a.ply"});
  expect_error(read("plx\n"), ErrorCode::corrupt, {"line 1"});
  expect_error(read("ply\nformat ascii 1.0\n" + vertex), ErrorCode::truncated, {"end_header"});
  expect_error(read("ply\n" + vertex + "end_header\n"), ErrorCode::corrupt, {"format"});
  expect_error(read("ply\nformat ascii 2.0\n"), ErrorCode::unsupported, {"line 2", "2.0"});
  expect_error(read("ply\nformat text 1.0\n"), ErrorCode::unsupported, {"line 2", "text"});
  expect_error(read(header("")), ErrorCode::unsupported, {"vertex"});
  expect_error(read(header("element vertex 0\nproperty float x\n")), ErrorCode::unsupported,
               {"line 3", "'y'"});
  expect_error(read(header(vertex + "property float x\n")), ErrorCode::corrupt, {"'x'", "twice"});
  expect_error(read(header(vertex + "property list uchar int a\n")), ErrorCode::unsupported, {"list"});
  expect_error(read(header(vertex + "property int64 t\n")), ErrorCode::unsupported, {"int64"});
  expect_error(read(header(vertex + "element face 0\nproperty list float int a\n")), ErrorCode::corrupt,
               {"line 8"});
  expect_error(read(header(vertex + "element vertex 0\n")), ErrorCode::corrupt, {"line 7", "twice"});
  expect_error(read(header("property float x\n")), ErrorCode::corrupt, {"line 3"});
  expect_error(read(header("element vertex many\n")), ErrorCode::corrupt, {"line 3"});
  expect_error(read(header("elephant\n")), ErrorCode::corrupt, {"elephant"});
}

TEST_F(PlyFile, RefusesTypesAndEncodingsThatItDoesNotHave) {
  const auto path = folder_.path() / "out.ply";
  const PointCloud cloud{{{1, 2, 3}}, {{"t", std::vector<std::uint64_t>{1}}}};
  expect_error(write_cloud(path, cloud, CloudFormat::ply), ErrorCode::unsupported,
               {"out.ply", "'t'", "64-bit"});
  expect_error(write_cloud(path, {}, CloudFormat::ply, CloudEncoding::binary_compressed),
               ErrorCode::invalid_argument, {"out.ply"});
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace pointreel
