// Fields of real sweeps from $POINTREEL_DATA, on a grid good enough for contexts.
#include <gtest/gtest.h>

#include <cmath>

#include "base/trigonometry.h"
#include "fields/field_samples.h"
#include "pointreel/io.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

// Rows from the ring field, or begun anew wherever the azimuth drops; columns from the azimuth.
SampleGrid grid_of(const PointCloud& cloud) {
  constexpr std::uint32_t kColumns = 2400;
  SampleGrid grid(0, 0);
  grid.rows = 64;
  grid.columns = kColumns;
  const Field* ring = cloud.find_field("ring");
  std::uint32_t row = 0, next_column = 0;
  double azimuth_before = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3f& p = cloud.positions[i];
    const double azimuth = std::atan2(p.y, p.x) + (p.y < 0 ? kTurn : 0);
    const auto column = static_cast<std::uint32_t>(azimuth / kTurn * 2000);
    if (ring != nullptr) {
      grid.cell_of_point.push_back(std::get<std::vector<std::uint16_t>>(ring->values)[i] * kColumns + column);
    } else {
      if (azimuth < azimuth_before - 1) ++row, next_column = 0;
      next_column = std::max(next_column, column);
      grid.cell_of_point.push_back(static_cast<std::int32_t>(row * kColumns + next_column++));
    }
    azimuth_before = azimuth;
    grid.range_m.push_back(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
  }
  return grid;
}

// Mean over the sweeps, each of which starts anew.
double exact_bits_per_point(const std::string& set, const std::string& name) {
  const auto paths = expand_inputs(std::vector<std::string>{(*real_data_folder() / set).string()});
  EXPECT_TRUE(paths) << paths.error().message;
  double bits = 0, points = 0;
  for (const auto& path : *paths) {
    const auto cloud = read_cloud(path);
    EXPECT_TRUE(cloud) << cloud.error().message;
    const Field* field = cloud->find_field(name);
    EXPECT_NE(field, nullptr);
    const SampleGrid grid = grid_of(*cloud);
    const PointLayout layout = grid.layout();
    FieldMemory encoder, decoder;
    const auto bytes = encode_field(field->values, 0, layout, encoder);
    const auto decoded = decode_field(bytes, field->values.index(), layout, decoder);
    EXPECT_TRUE(decoded && same_bits(*decoded, field->values)) << path << ' ' << name;
    bits += 8.0 * static_cast<double>(bytes.size());
    points += static_cast<double>(cloud->size());
  }
  return bits / points;
}

TEST(RealFields, IntensityTakesLessThanThreeAndThreeQuarterBits) {
  if (!real_data_folder()) GTEST_SKIP() << "POINTREEL_DATA is not set";
  EXPECT_LT(exact_bits_per_point("kitti_raw_0005", "intensity"), 3.75);
  EXPECT_LT(exact_bits_per_point("kitti_raw_0001", "intensity"), 3.75);
}

TEST(RealFields, RingAndTimestampAreAlmostFree) {
  if (!real_data_folder()) GTEST_SKIP() << "POINTREEL_DATA is not set";
  EXPECT_LT(
      exact_bits_per_point("ring_time_pcd", "ring") + exact_bits_per_point("ring_time_pcd", "timestamp"),
      0.1);
}

}  // namespace
}  // namespace pointreel
