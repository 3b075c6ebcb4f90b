#include "sensor/sensor_coding.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "base/trigonometry.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

SensorModel small_model() {
  SensorModel model;
  for (int r = 0; r < 8; ++r)
    model.rows.push_back(
        rounded({0.1 - 0.05 * r, 0.2 - 0.01 * r, 0.03 * r - 0.1, r % 2 == 0 ? 0.026 : -0.026}));
  model.ticks_per_turn = 4000;
  model.row_sequence = {7, 6, 5, 4, 0, 1, 2, 3};
  model.row_delay = {0, 0, 3, 1023, 2, 0, 0, 1};
  model.ring_of_row = {10, 11, 12, 13, 3, 2, 1, 0};
  model.range_step_m = 0.002;
  model.range_phase = {0, 0.5, 0.25, 0.75, 0, 0, 0.984375, 0.5};
  return model;
}

SweepGrid small_grid() {
  SweepGrid grid;
  grid.ticks_per_turn = 4000;
  for (std::uint32_t c = 0; c < 2000; ++c) grid.column_tick.push_back(2 * c - c / 24);
  grid.order = {OrderKind::row_azimuth, false, 17};
  return grid;
}

TEST(SensorCoding, ModelComesBackExactly) {
  const SensorModel model = small_model();
  const auto decoded = decode_sensor_model(encode_sensor_model(model));
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(*decoded, model);
}

TEST(SensorCoding, EmptyModelComesBack) {
  const auto decoded = decode_sensor_model(encode_sensor_model({}));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(*decoded, SensorModel{});
}

TEST(SensorCoding, RoundingAModelTwiceChangesNothing) {
  for (const RowModel& row : small_model().rows) EXPECT_EQ(rounded(row), row);
  EXPECT_NEAR(rounded({0, 0, kTurn + 0.25, 0}).azimuth_rad, 0.25, 1e-6);
}

TEST(SensorCoding, SteadyRotationCostsLittle) {
  const SensorModel model = small_model();
  const SweepGrid grid = small_grid();
  const auto bytes = encode_sweep_grid(model, grid);
  EXPECT_LT(bytes.size(), 130u);
  const auto decoded = decode_sweep_grid(model, bytes);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(*decoded, grid);
}

TEST(SensorCoding, MotionAndOwnTicksComeBack) {
  SensorModel model = small_model();
  model.ticks_per_turn = 0;
  model.motion_compensated = true;
  SweepGrid grid = small_grid();
  grid.ticks_per_turn = 1 << 17;
  grid.motion = Twist{{100 * kTwistStep, -3 * kTwistStep, 0}, {kTwistStep, 0, -900 * kTwistStep}};
  const auto decoded = decode_sweep_grid(model, encode_sweep_grid(model, grid));
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(*decoded, grid);
}

TEST(SensorCoding, GridThatIsTooLargeForTheModelIsCorrupt) {
  SensorModel few = small_model();
  SweepGrid grid;
  grid.ticks_per_turn = 1 << 17;
  few.ticks_per_turn = 0;
  for (std::uint32_t c = 0; c < 60000; ++c) grid.column_tick.push_back(2 * c);
  const auto bytes = encode_sweep_grid(few, grid);
  EXPECT_TRUE(decode_sweep_grid(few, bytes));
  SensorModel many = few;
  many.rows.resize(kMaxRows);
  expect_error(decode_sweep_grid(many, bytes), ErrorCode::corrupt, "grid");
}

RC_GTEST_PROP(SensorCoding, AnyBytesAreAnErrorOrAModelWithinLimits, (std::vector<std::uint8_t> bytes)) {
  const auto model = decode_sensor_model(bytes);
  if (!model) return;
  RC_ASSERT(model->rows.size() <= kMaxRows);
  RC_ASSERT(model->row_sequence.size() == model->rows.size());
  RC_ASSERT(model->ticks_per_turn <= kMaxTicksPerTurn);
}

RC_GTEST_PROP(SensorCoding, DamagedGridIsAnErrorOrWithinLimits, ()) {
  const SensorModel model = small_model();
  auto bytes = encode_sweep_grid(model, small_grid());
  const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
  bytes[at] = *rc::gen::arbitrary<std::uint8_t>();
  bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size() + 1));
  const auto grid = decode_sweep_grid(model, bytes);
  if (!grid) return;
  RC_ASSERT(grid->column_count() <= kMaxColumns);
  for (std::size_t c = 1; c < grid->column_count(); ++c)
    RC_ASSERT(grid->column_tick[c] > grid->column_tick[c - 1] &&
              grid->column_tick[c] < 2 * grid->ticks_per_turn);
  RC_ASSERT(grid->order.seam_tick < grid->ticks_per_turn);
}

}  // namespace
}  // namespace pointreel
