#include "fields/field_coding.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "fields/field_samples.h"

namespace pointreel {
namespace {

FieldValues round_trip(const FieldValues& values, double step, const PointLayout& layout,
                       std::size_t* bytes = nullptr) {
  FieldMemory encoder, decoder;
  const auto coded = encode_field(values, step, layout, encoder);
  if (bytes != nullptr) *bytes = coded.size();
  auto decoded = decode_field(coded, values.index(), layout, decoder);
  EXPECT_TRUE(decoded) << decoded.error().message;
  return decoded ? *std::move(decoded) : FieldValues{};
}

double bits_per_point(const FieldValues& values, const PointLayout& layout) {
  std::size_t bytes = 0;
  EXPECT_TRUE(same_bits(round_trip(values, 0, layout, &bytes), values));
  return 8.0 * static_cast<double>(bytes) / static_cast<double>(layout.size());
}

template <class T>
class FieldOfType : public testing::Test {};
using FieldTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                                  std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(FieldOfType, FieldTypes);

template <class T>
std::vector<T> extremes() {
  using Limits = std::numeric_limits<T>;
  std::vector<T> values = {T{0}, T{1}, Limits::max(), Limits::lowest(), Limits::min(), static_cast<T>(-1)};
  if constexpr (std::is_floating_point_v<T>) {
    for (const T value :
         {-T{0}, Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN(),
          Limits::signaling_NaN(), Limits::denorm_min(), -Limits::denorm_min()}) {
      values.push_back(value);
    }
  }
  return values;
}

TYPED_TEST(FieldOfType, KeepsEveryBitOfAnyValues) {
  const SampleGrid grid(7, 40);
  const PointLayout layout = grid.layout();
  std::mt19937_64 random(3);
  const auto special = extremes<TypeParam>();
  for (const unsigned share_of_extremes : {0u, 1u, 30u, 100u}) {
    for (const unsigned distinct : {1u, 2u, 40u, 100'000u}) {
      std::vector<TypeParam> pool;
      for (unsigned i = 0; i < std::min<std::size_t>(distinct, grid.size()); ++i) {
        pool.push_back(any_bits<TypeParam>(random));
      }
      std::vector<TypeParam> values;
      for (std::size_t i = 0; i < grid.size(); ++i) {
        values.push_back(random() % 100 < share_of_extremes ? special[random() % special.size()]
                                                            : pool[random() % pool.size()]);
      }
      EXPECT_TRUE(same_bits(round_trip(values, 0, layout), values));
    }
  }
}

TYPED_TEST(FieldOfType, StaysWithinTheStep) {
  const SampleGrid grid(7, 200);
  const PointLayout layout = grid.layout();
  std::mt19937_64 random(5);
  const auto special = extremes<TypeParam>();
  for (const double step : {1e-30, 0.01, 0.02, 0.3, 1.0, 2.7, 1000.0, 1e30}) {
    for (const bool few : {true, false}) {
      std::vector<TypeParam> values;
      for (std::size_t i = 0; i < grid.size(); ++i) {
        const auto hundredths = static_cast<double>(random() % (few ? 100 : 1'000'000)) / 100;
        values.push_back(i % 97 == 5 ? special[random() % special.size()]
                                     : static_cast<TypeParam>(hundredths));
      }
      const auto decoded = std::get<std::vector<TypeParam>>(round_trip(values, step, layout));
      ASSERT_EQ(decoded.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        if constexpr (std::is_integral_v<TypeParam>) {
          // Of 64-bit integers a long double holds every one.
          const auto off =
              std::fabs(static_cast<long double>(decoded[i]) - static_cast<long double>(values[i]));
          ASSERT_LE(off, static_cast<long double>(step));
        } else if (std::isfinite(values[i])) {
          ASSERT_LE(std::fabs(static_cast<double>(decoded[i]) - static_cast<double>(values[i])), step);
        } else {
          ASSERT_EQ(std::memcmp(&decoded[i], &values[i], sizeof(TypeParam)), 0);
        }
      }
    }
  }
}

RC_GTEST_PROP(FieldCoding, KeepsEveryBitWithAnyGridAndMemory, ()) {
  const auto rows = *rc::gen::inRange<std::uint32_t>(0, 6);
  const auto columns = *rc::gen::inRange<std::uint32_t>(0, 20);
  const auto cells = *rc::gen::container<std::vector<std::int32_t>>(
      rc::gen::inRange<std::int32_t>(-2, static_cast<std::int32_t>(rows * columns) + 2));
  const std::vector<float> ranges(cells.size(), 2.5f);
  const PointLayout layout({rows, columns, cells, ranges});
  FieldMemory encoder, decoder;
  for (int sweep = 0; sweep < 3; ++sweep) {
    std::vector<float> values;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      values.push_back(static_cast<float>(*rc::gen::inRange(0, 9)) / 10.0f);
    }
    const FieldValues field = values;
    const auto decoded =
        decode_field(encode_field(field, 0, layout, encoder), field.index(), layout, decoder);
    RC_ASSERT(static_cast<bool>(decoded));
    RC_ASSERT(same_bits(*decoded, field));
  }
}

TEST(FieldCoding, CodesNoPointsAtAll) {
  const PointLayout layout{FieldContext{}};
  for (const FieldValues& empty :
       {FieldValues{std::vector<float>{}}, FieldValues{std::vector<std::int8_t>{}}}) {
    EXPECT_TRUE(same_bits(round_trip(empty, 0, layout), empty));
    EXPECT_TRUE(same_bits(round_trip(empty, 0.1, layout), empty));
  }
}

TEST(FieldCoding, RingsAndTimestampsCostNextToNothing) {
  const SampleGrid grid(32, 900);
  const PointLayout layout = grid.layout();
  std::vector<std::uint16_t> ring;
  std::vector<double> by_column, by_packet;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const auto cell = static_cast<std::uint32_t>(std::max(grid.cell_of_point[i], 0));
    ring.push_back(static_cast<std::uint16_t>(cell / grid.columns));
    by_column.push_back(1.6e9 + 55.5e-6 * (cell % grid.columns));
    by_packet.push_back(1.6e9 + 333.1e-6 * static_cast<double>(i / 270));
  }
  EXPECT_LT(bits_per_point(ring, layout), 0.2);  // mostly for the points off the grid, which have any ring
  EXPECT_LT(bits_per_point(by_column, layout), 0.5);
  EXPECT_LT(bits_per_point(by_packet, layout), 0.08);
  EXPECT_LT(bits_per_point(std::vector<float>(grid.size(), 0.25f), layout), 0.02);
}

TEST(FieldCoding, SymbolsCostWhatTheirNoiseDoes) {
  const SampleGrid grid(64, 1000);
  const PointLayout layout = grid.layout();
  std::mt19937 random(7);
  std::vector<float> intensity;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const auto cell = static_cast<std::uint32_t>(std::max(grid.cell_of_point[i], 0));
    const auto surface = 10 * (cell % grid.columns / 100) + cell / grid.columns / 16;
    intensity.push_back(static_cast<float>(surface + random() % 4) / 100);
  }
  EXPECT_LT(bits_per_point(intensity, layout), 2.4);  // 2 bits are noise
}

TEST(FieldCoding, MemoryShortensLaterSweepsAndSurvivesNewValues) {
  const SampleGrid grid(16, 300);
  const PointLayout layout = grid.layout();
  std::mt19937 random(9);
  FieldMemory encoder, decoder;
  std::vector<std::size_t> sizes;
  for (const unsigned largest : {50u, 50u, 50u, 80u, 50u}) {
    std::vector<float> values;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const auto row = static_cast<unsigned>(std::max(grid.cell_of_point[i], 0)) / grid.columns;
      values.push_back(static_cast<float>((7 * row + random() % 3) % largest) / 100);
    }
    const FieldValues field = values;
    const auto bytes = encode_field(field, 0, layout, encoder);
    sizes.push_back(bytes.size());
    const auto decoded = decode_field(bytes, field.index(), layout, decoder);
    ASSERT_TRUE(decoded);
    EXPECT_TRUE(same_bits(*decoded, field));
  }
  EXPECT_LT(sizes[1], sizes[0]);
}

TEST(FieldCoding, AStepSavesBits) {
  const SampleGrid grid(32, 500);
  const PointLayout layout = grid.layout();
  std::mt19937 random(11);
  std::vector<float> values;
  for (std::size_t i = 0; i < grid.size(); ++i) values.push_back(static_cast<float>(random() % 100) / 100);
  std::size_t exact = 0, coarse = 0;
  round_trip(values, 0, layout, &exact);
  round_trip(values, 0.02, layout, &coarse);
  // One value stands for five: log2(20) of log2(100) bits, and both learn first.
  EXPECT_LT(static_cast<double>(coarse), 0.72 * static_cast<double>(exact));
}

}  // namespace
}  // namespace pointreel
