// Damaged files end in an Error or in a cloud that keeps the invariant; run under the sanitizers as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <random>
#include <string>

#include "io/formats.h"

namespace pointreel {
namespace {

using io::parse_kitti, io::parse_nuscenes, io::parse_pcd, io::parse_ply;
using io::serialize_kitti, io::serialize_nuscenes, io::serialize_pcd, io::serialize_ply;

struct Kind {
  std::string_view name;
  CloudEncoding encoding;
  Result<PointCloud> (*parse)(std::string_view bytes, const std::string& file);
  Result<std::string> (*serialize)(const PointCloud& cloud, CloudEncoding encoding);

  // Without it GoogleTest prints addresses, which change the test's name from run to run.
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

// With faces after the points, which are lists.
Result<std::string> serialize_ply_mesh(const PointCloud& cloud, CloudEncoding encoding) {
  auto bytes = serialize_ply(cloud, encoding);
  if (!bytes) return bytes;
  bytes->insert(bytes->find("end_header"), "element face 3\nproperty list uchar uchar corners\n");
  return *bytes + "\3abc\4abcd\1a";
}

constexpr std::array kinds = {
    Kind{"Kitti", CloudEncoding::binary, parse_kitti, serialize_kitti},
    Kind{"NuScenes", CloudEncoding::binary, parse_nuscenes, serialize_nuscenes},
    Kind{"PcdAscii", CloudEncoding::ascii, parse_pcd, serialize_pcd},
    Kind{"PcdBinary", CloudEncoding::binary, parse_pcd, serialize_pcd},
    Kind{"PcdCompressed", CloudEncoding::binary_compressed, parse_pcd, serialize_pcd},
    Kind{"PlyAscii", CloudEncoding::ascii, parse_ply, serialize_ply},
    Kind{"PlyBinary", CloudEncoding::binary, parse_ply, serialize_ply},
    Kind{"PlyMesh", CloudEncoding::binary, parse_ply, serialize_ply_mesh},
};

// Repeats in part, so that LZF has something to refer back to.
PointCloud small_cloud() {
  constexpr std::size_t count = 24;
  PointCloud cloud;
  std::vector<float> intensity;
  std::vector<std::uint16_t> ring;
  std::vector<double> timestamp;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<float>(i);
    cloud.positions.push_back({value * 0.37f, -value, 1});
    intensity.push_back(value / 255);
    ring.push_back(static_cast<std::uint16_t>(i % 4));
    timestamp.push_back(1.6e9 + 1e-4 * static_cast<double>(i));
  }
  cloud.fields = {{"intensity", intensity}, {"ring", ring}, {"timestamp", timestamp}};
  return cloud;
}

class HostileFiles : public testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    const auto bytes = GetParam().serialize(small_cloud(), GetParam().encoding);
    ASSERT_TRUE(bytes);
    valid_ = *bytes;
    ASSERT_TRUE(parse(valid_));
  }

  // True when the damaged bytes were still read as a cloud.
  bool parse(const std::string& bytes) {
    const auto cloud = GetParam().parse(bytes, "folder/damaged");
    if (!cloud) {
      EXPECT_TRUE(cloud.error().message.starts_with("folder/damaged, ")) << cloud.error().message;
      return false;
    }
    for (const Field& field : cloud->fields) EXPECT_EQ(field.size(), cloud->size());
    return true;
  }

  std::string valid_;
  std::mt19937 random_{20240229};
};

TEST_P(HostileFiles, CutAtAnyLength) {
  const bool has_header = GetParam().name.starts_with("P");
  for (std::size_t length = 0; length < valid_.size(); ++length) {
    const bool was_parsed = parse(valid_.substr(0, length));
    // A number in text may lose digits or the last line end unnoticed; nothing else may.
    const bool may_pass =
        GetParam().encoding == CloudEncoding::ascii && valid_.find('\n', length) + 1 == valid_.size();
    if (has_header && !may_pass) {
      EXPECT_FALSE(was_parsed) << "cut at " << length << " of " << valid_.size();
    }
  }
}

TEST_P(HostileFiles, FlippedBits) {
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = valid_;
    for (auto flips = 1 + random_() % 3; flips > 0; --flips) {
      bytes[random_() % bytes.size()] ^= static_cast<char>(1 << random_() % 8);
    }
    parse(bytes);
  }
}

TEST_P(HostileFiles, WrongNumbersInTheHeader) {
  constexpr std::string_view digits = "0123456789";
  const std::size_t header_end = std::min(valid_.size(), std::size_t{300});
  for (std::size_t at = valid_.find_first_of(digits); at < header_end;
       at = valid_.find_first_of(digits, at)) {
    const std::size_t end = std::min(valid_.find_first_not_of(digits, at), valid_.size());
    for (const auto number :
         {"", "0", "-1", "1", "8", "25", "65536", "4294967295", "4294967296", "1000000000000",
          "9223372036854775807", "18446744073709551615", "99999999999999999999", "1e9", "nan"}) {
      parse(valid_.substr(0, at) + number + valid_.substr(end));
    }
    at = end;
  }
}

TEST_P(HostileFiles, ExtraMissingAndRepeatedBytes) {
  for (int i = 0; i < 500; ++i) {
    const std::size_t at = random_() % valid_.size();
    const std::size_t length = 1 + random_() % std::min<std::size_t>(64, valid_.size() - at);
    parse(valid_.substr(0, at) + valid_.substr(at + length));
    parse(valid_.substr(0, at + length) + valid_.substr(at));
    parse(valid_.substr(0, at) + std::string(length, static_cast<char>(random_())) + valid_.substr(at));
  }
}

INSTANTIATE_TEST_SUITE_P(EveryKind, HostileFiles, testing::ValuesIn(kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace pointreel
