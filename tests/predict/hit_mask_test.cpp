#include "predict/hit_mask.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "entropy/adaptive_models.h"

namespace pointreel {
namespace {

struct Sweep {
  int rows = 0;
  int columns = 0;
  std::vector<float> range_m;  // 0 = no return

  std::size_t points() const {
    std::size_t count = 0;
    for (const float range : range_m) count += range > 0 ? 1 : 0;
    return count;
  }
};

// Ground that comes nearer row by row below a sky, with a box and a few lost returns.
Sweep street(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  Sweep sweep{rows, columns, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool box = column % 200 < 40 && row > rows / 8;
      const bool sky = row < rows / 4;
      const bool lost = random() % 100 == 0;
      const float ground_m = 60.0f / static_cast<float>(1 + row);
      sweep.range_m.push_back(lost ? 0 : box ? 8.0f : sky ? 0 : ground_m);
    }
  }
  return sweep;
}

std::vector<std::uint8_t> reference_from(const Sweep& sweep) {
  std::vector<std::uint8_t> reference;
  for (const float range : sweep.range_m) {
    reference.push_back(range > 0                   ? kWarpedHit | kPreviousHit
                        : reference.size() % 3 == 0 ? kWarpedFilled
                                                    : 0);
  }
  return reference;
}

HitMaskModel model_for(const Sweep& sweep, std::span<const std::uint8_t> reference) {
  return {{0, sweep.rows, sweep.columns, sweep.rows}, reference, HitMaskState::from_priors(sweep.rows)};
}

std::vector<std::uint8_t> encode(const Sweep& sweep, std::span<const std::uint8_t> reference) {
  BitEncoder coder;
  HitMaskModel model = model_for(sweep, reference);
  std::size_t cell = 0;
  for (int row = 0; row < sweep.rows; ++row) {
    model.begin_row();
    for (int column = 0; column < sweep.columns; ++column, ++cell) {
      const float range_m = sweep.range_m[cell];
      if (model.code(coder, range_m > 0)) model.set_range(range_m);
    }
  }
  return coder.finish();
}

// Ranges come from `sweep`, as if decoded beside the mask; where it has none although the bits say hit: 5 m.
std::vector<bool> decode(const std::vector<std::uint8_t>& bytes, const Sweep& sweep,
                         std::span<const std::uint8_t> reference) {
  BitDecoder coder(bytes);
  HitMaskModel model = model_for(sweep, reference);
  std::vector<bool> hits;
  for (int row = 0; row < sweep.rows; ++row) {
    model.begin_row();
    for (int column = 0; column < sweep.columns; ++column) {
      const float range_m = sweep.range_m[hits.size()];
      hits.push_back(model.code(coder, false));
      if (hits.back()) model.set_range(range_m > 0 ? range_m : 5.0f);
    }
  }
  return hits;
}

std::vector<bool> hits_of(const Sweep& sweep) {
  std::vector<bool> hits;
  for (const float range : sweep.range_m) hits.push_back(range > 0);
  return hits;
}

class HitMaskSizes : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(HitMaskSizes, ComesBackWithAndWithoutAReference) {
  const auto [rows, columns] = GetParam();
  const Sweep sweep = street(rows, columns, 1);
  const auto reference = reference_from(street(rows, columns, 2));
  EXPECT_EQ(decode(encode(sweep, {}), sweep, {}), hits_of(sweep));
  EXPECT_EQ(decode(encode(sweep, reference), sweep, reference), hits_of(sweep));
}

INSTANTIATE_TEST_SUITE_P(Sizes, HitMaskSizes,
                         testing::Combine(testing::Values(1, 2, 3, 64, 200),
                                          testing::Values(1, 2, 7, 17, 18, 500)));

TEST(HitMask, NoiseComesBackWhateverTheRanges) {
  std::mt19937 random(7);
  Sweep sweep{40, 333, {}};
  for (int i = 0; i < sweep.rows * sweep.columns; ++i) {
    const float range_m = random() % 4 == 0   ? 1e-6f
                          : random() % 3 == 0 ? 1e30f
                                              : 1.0f + static_cast<float>(i);
    sweep.range_m.push_back(random() % 2 == 0 ? 0.0f : range_m);
  }
  const auto bytes = encode(sweep, {});
  EXPECT_EQ(decode(bytes, sweep, {}), hits_of(sweep));
  // Priors that trust the neighbours must be unlearned soon.
  EXPECT_LT(bytes.size() * 8, sweep.range_m.size() * 5 / 4);
}

TEST(HitMask, AStreetCostsLittleAndAReferenceHelps) {
  const Sweep sweep = street(64, 2000, 1);
  const auto alone = encode(sweep, {});
  // 1 % of the returns are lost at random: 0.081 bits a cell are the least.
  EXPECT_LT(static_cast<double>(alone.size()) * 8, 0.12 * 64 * 2000);
  EXPECT_LT(encode(sweep, reference_from(sweep)).size(), alone.size());
}

TEST(HitMask, AnyBytesDecodeToSomeMask) {
  std::mt19937 random(11);
  const Sweep sweep = street(64, 500, 1);
  const auto reference = reference_from(sweep);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::uint8_t> bytes(4000);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(trial == 0 ? 0 : trial == 1 ? 0xFF : random());
    // The sanitizers watch the indices and the arithmetic.
    EXPECT_EQ(decode(bytes, sweep, reference).size(), sweep.range_m.size());
  }
}

}  // namespace
}  // namespace pointreel
