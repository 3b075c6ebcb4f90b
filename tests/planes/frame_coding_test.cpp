// Encoder and decoder of one range image agree exactly, and every cell keeps its bound, whatever the image.
#include "planes/frame_coding.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "planes/projection.h"
#include "test_images.h"

namespace pointreel {
namespace {

void expect_same_frame(const KeyFrame& a, const KeyFrame& b) {
  RC_ASSERT(a.image.first_row == b.image.first_row);
  RC_ASSERT(a.image.rows == b.image.rows);
  RC_ASSERT(a.image.columns == b.image.columns);
  RC_ASSERT(a.image.range_m == b.image.range_m);
  RC_ASSERT(a.planes.run_of_tile == b.planes.run_of_tile);
  RC_ASSERT(a.planes.runs.size() == b.planes.runs.size());
  for (std::size_t i = 0; i < a.planes.runs.size(); ++i) {
    const PlaneRun &p = a.planes.runs[i], &q = b.planes.runs[i];
    RC_ASSERT(p.kind == q.kind && p.first_tile == q.first_tile && p.end_tile == q.end_tile);
    RC_ASSERT(p.plane.x == q.plane.x && p.plane.y == q.plane.y && p.plane.z == q.plane.z);
  }
}

// Ranges are float32: on top of the bound comes the rounding of the decoded range.
void expect_within_bound(const RangeImage& image, const RangeImage& decoded, double bound_m) {
  RC_ASSERT(image.range_m.size() == decoded.range_m.size());
  for (std::size_t i = 0; i < image.range_m.size(); ++i) {
    const double range_m = image.range_m[i];
    RC_ASSERT((range_m > 0) == (decoded.range_m[i] > 0));
    RC_ASSERT(std::fabs(decoded.range_m[i] - range_m) <= bound_m * (1 + 1e-6) + range_m * 0x1p-24);
  }
}

// Any scene: planes, noise of any size, ranges from millimetres to kilometres, any share of empty cells.
RangeImage any_image(const AngularGrid& grid, int tile_size, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
  const int first_tile_row = below(grid.rows() / tile_size);
  const int tile_rows = 1 + below(std::min(4, grid.rows() / tile_size - first_tile_row));
  RangeImage image =
      image_of_planes(grid, first_tile_row * tile_size, tile_rows * tile_size, street_canyon());
  switch (below(5)) {
    case 0:
      break;
    case 1:
      add_noise(image, 0.02f, seed);
      break;
    case 2:
      add_noise(image, 1.0f, seed);
      break;
    case 3: {
      std::uniform_real_distribution<float> near_m(1e-6f, 0.5f);
      for (float& range : image.range_m) range = near_m(random);
      break;
    }
    default: {
      std::uniform_real_distribution<float> log10_range(-4, 5);
      for (float& range : image.range_m) range = std::min(1e5f, std::pow(10.0f, log10_range(random)));
    }
  }
  const int empty_percent = below(5) == 0 ? 0 : below(101);
  for (float& range : image.range_m) {
    if (below(100) < empty_percent) range = 0;
  }
  return image;
}

FrameSettings any_settings() {
  FrameSettings settings;
  settings.tile_size = *rc::gen::inRange(2, 17);
  settings.tolerance.threshold_m = *rc::gen::element(0.001f, 0.02f, 0.1f, 0.5f, 10.0f);
  settings.tolerance.plane_step_m = settings.tolerance.threshold_m * 0.5;
  const double step_per_threshold = *rc::gen::element(0.0, 1.0, 2.0);  // 0: raw
  settings.residual_step_m = settings.tolerance.threshold_m * step_per_threshold;
  return settings;
}

double bound_m(const FrameSettings& settings) {
  return std::max<double>(settings.tolerance.threshold_m, settings.residual_step_m / 2);
}

std::uint32_t any_seed() {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint32_t>());
}

RC_GTEST_PROP(FrameCoding, DecodesToTheEncodersOwnReconstruction, ()) {
  const AngularGrid grid = grid_of_degrees(*rc::gen::element(2.0, 3.3, 5.0), 3);
  const FrameSettings settings = any_settings();
  const RangeImage key_image = any_image(grid, settings.tile_size, any_seed());
  const CodedFrame key = encode_frame(grid, key_image, settings, nullptr, 1);
  const auto decoded_key = decode_frame(grid, key.bytes, settings, nullptr);
  RC_ASSERT(bool(decoded_key));
  expect_same_frame(*decoded_key, key.decoded);
  expect_within_bound(key_image, decoded_key->image, bound_m(settings));

  // A predicted frame of the same scene moved, or of another one in another band of rows.
  RangeImage image =
      *rc::gen::arbitrary<bool>() ? any_image(grid, settings.tile_size, any_seed()) : key_image;
  const float moved_m = *rc::gen::element(0.0f, 0.04f, 0.5f);
  for (float& range : image.range_m) {
    if (range > 0) range = std::min(1e5f, range + moved_m);
  }
  const CodedFrame frame = encode_frame(grid, image, settings, &key.decoded, 1);
  const auto decoded = decode_frame(grid, frame.bytes, settings, &*decoded_key);
  RC_ASSERT(bool(decoded));
  expect_same_frame(*decoded, frame.decoded);
  expect_within_bound(image, decoded->image, bound_m(settings));

  const FrameStatistics& statistics = frame.statistics;
  RC_ASSERT(statistics.spatial_cells + statistics.temporal_cells + statistics.unfit_cells ==
            count_occupied(image));
  RC_ASSERT(statistics.runs == frame.decoded.planes.runs.size());
}

// Where ranges are smaller than the threshold, a plane behind the sensor is "within" it as well.
TEST(FrameCoding, ScenesNearerThanTheThresholdDecode) {
  const AngularGrid grid = grid_of_degrees(2, 2);
  std::mt19937 random(8);
  std::uniform_real_distribution<float> range_m(0.01f, 2.0f);
  RangeImage image = empty_image(grid, 40, 8);
  for (float& range : image.range_m) range = range_m(random);
  RangeImage key_image = image;
  for (float& range : key_image.range_m) range *= 3;
  FrameSettings settings;
  settings.tolerance = {10.0f, 5.0};
  settings.residual_step_m = 20;
  const CodedFrame key = encode_frame(grid, key_image, settings, nullptr, 1);
  EXPECT_TRUE(decode_frame(grid, key.bytes, settings, nullptr));
  EXPECT_EQ(count_occupied(key.decoded.image), count_occupied(key_image));
  const CodedFrame frame = encode_frame(grid, image, settings, &key.decoded, 1);
  EXPECT_TRUE(decode_frame(grid, frame.bytes, settings, &key.decoded));
  EXPECT_EQ(count_occupied(frame.decoded.image), count_occupied(image));
}

TEST(FrameCoding, RawRangesOfUnfitCellsAreExact) {
  const AngularGrid grid = grid_of_degrees(2, 2);
  RangeImage image = empty_image(grid, 40, 8);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> range_m(1, 100);
  for (float& range : image.range_m) range = range_m(random);
  FrameSettings settings;
  settings.tolerance = {0.001f, 0.0005};
  settings.residual_step_m = 0;
  const CodedFrame frame = encode_frame(grid, image, settings, nullptr, 1);
  ASSERT_EQ(frame.statistics.unfit_cells, count_occupied(image));
  EXPECT_EQ(frame.decoded.image.range_m, image.range_m);
}

TEST(FrameCoding, BytesDoNotDependOnThreads) {
  const AngularGrid grid = grid_of_degrees(0.18, 0.45);
  RangeImage image = image_of_planes(grid, 192, 64, street_canyon());
  add_noise(image, 0.05f, 2);
  const auto bytes = encode_frame(grid, image, {}, nullptr, 1).bytes;
  for (const int threads : {2, 3, 8}) EXPECT_EQ(encode_frame(grid, image, {}, nullptr, threads).bytes, bytes);
}

TEST(FrameCoding, AnEmptyImageIsAFewBytesAndAValidKeyFrame) {
  const AngularGrid grid = grid_of_degrees(1, 1);
  const RangeImage nothing = empty_image(grid, 0, 0);
  const CodedFrame key = encode_frame(grid, nothing, {}, nullptr, 2);
  EXPECT_LE(key.bytes.size(), 16u);
  const RangeImage scene = image_of_planes(grid, 80, 16, street_canyon());
  const CodedFrame frame = encode_frame(grid, scene, {}, &key.decoded, 1);
  const auto decoded = decode_frame(grid, frame.bytes, {}, &key.decoded);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->image.range_m, frame.decoded.image.range_m);
  const CodedFrame empty_again = encode_frame(grid, nothing, {}, &frame.decoded, 1);
  EXPECT_TRUE(decode_frame(grid, empty_again.bytes, {}, &frame.decoded));
}

TEST(FrameCoding, RowsOutsideTheGridAreRejected) {
  const AngularGrid grid = grid_of_degrees(1, 1);
  const CodedFrame frame = encode_frame(grid, empty_image(grid, 176, 4), {}, nullptr, 1);
  ASSERT_TRUE(decode_frame(grid, frame.bytes, {}, nullptr));
  // First row and number of rows, in tiles of 4: the grid has 180 rows.
  for (const auto& [first, rows] :
       {std::pair{45, 1}, {46, 0}, {44, 2}, {0, 46}, {0xFFFF, 0xFFFF}, {0, 0xFFFF}}) {
    auto bytes = frame.bytes;
    bytes[0] = static_cast<std::uint8_t>(first), bytes[1] = static_cast<std::uint8_t>(first >> 8);
    bytes[2] = static_cast<std::uint8_t>(rows), bytes[3] = static_cast<std::uint8_t>(rows >> 8);
    EXPECT_FALSE(decode_frame(grid, bytes, {}, nullptr)) << first << " + " << rows;
  }
  for (std::size_t size = 0; size < 4; ++size) {
    const auto cut = decode_frame(grid, std::span(frame.bytes).first(size), {}, nullptr);
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().code, ErrorCode::truncated);
  }
}

}  // namespace
}  // namespace pointreel
