// What is written and read again is the same cloud: random fields of every type with random bits.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>

#include "io/scalar_types.h"
#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

// Any bit pattern: for floats that includes NaN, infinities, -0 and subnormal numbers.
template <class T>
std::vector<T> any_values(std::size_t count) {
  const auto bits = *rc::gen::container<std::vector<std::uint64_t>>(
      count, rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>()));
  std::vector<T> values(count);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(&values[i], &bits[i], sizeof(T));
  return values;
}

enum class Integers : std::uint8_t { all, up_to_32_bits };

PointCloud any_cloud(Integers integers) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 40);
  const auto type_numbers = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 10));
  PointCloud cloud;
  const auto x = any_values<float>(count), y = any_values<float>(count), z = any_values<float>(count);
  for (std::size_t i = 0; i < count; ++i) cloud.positions.push_back({x[i], y[i], z[i]});
  for (const int number : type_numbers) {
    const auto type = static_cast<io::ScalarType>(number);
    if (integers == Integers::up_to_32_bits && !io::is_float(type) && io::size_of(type) == 8) continue;
    io::visit_scalar_type(type, [&]<class T>() {
      cloud.fields.push_back({"f" + std::to_string(cloud.fields.size()), any_values<T>(count)});
    });
  }
  return cloud;
}

void check_round_trip(const PointCloud& cloud, CloudFormat format, CloudEncoding encoding) {
  const TemporaryFolder folder;
  const auto path = folder.path() / ("cloud" + std::string(file_extension(format)));
  const auto written = write_cloud(path, cloud, format, encoding);
  RC_ASSERT(bool(written));
  const auto again = read_cloud(path);
  RC_ASSERT(bool(again));
  const auto payload = encoding == CloudEncoding::ascii ? NanPayload::any : NanPayload::exact;
  RC_ASSERT(same_cloud(cloud, *again, payload));
}

RC_GTEST_PROP(RoundTrip, PcdAscii, ()) {
  check_round_trip(any_cloud(Integers::all), CloudFormat::pcd, CloudEncoding::ascii);
}

RC_GTEST_PROP(RoundTrip, PcdBinary, ()) {
  check_round_trip(any_cloud(Integers::all), CloudFormat::pcd, CloudEncoding::binary);
}

RC_GTEST_PROP(RoundTrip, PcdBinaryCompressed, ()) {
  check_round_trip(any_cloud(Integers::all), CloudFormat::pcd, CloudEncoding::binary_compressed);
}

RC_GTEST_PROP(RoundTrip, PlyAscii, ()) {
  check_round_trip(any_cloud(Integers::up_to_32_bits), CloudFormat::ply, CloudEncoding::ascii);
}

RC_GTEST_PROP(RoundTrip, PlyBinary, ()) {
  check_round_trip(any_cloud(Integers::up_to_32_bits), CloudFormat::ply, CloudEncoding::binary);
}

RC_GTEST_PROP(RoundTrip, KittiAndNuScenes, ()) {
  PointCloud cloud = any_cloud(Integers::all);
  cloud.fields = {{"intensity", any_values<float>(cloud.size())}};
  check_round_trip(cloud, CloudFormat::kitti, CloudEncoding::binary);
  cloud.fields.push_back({"ring", any_values<float>(cloud.size())});
  check_round_trip(cloud, CloudFormat::nuscenes, CloudEncoding::binary);
}

}  // namespace
}  // namespace pointreel
