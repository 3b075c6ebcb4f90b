// Bands of range images: what comes back, for every kind of frame.
#include "predict/band_coding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <tuple>
#include <vector>

#include "predict/priors.h"

namespace pointreel {
namespace {

constexpr float kStepM = 0.04F;

// Ground that comes nearer row by row below a sky, with a box and a few lost returns; `shift` turns the box.
GridImage street(int rows, int columns, unsigned seed, int shift = 0) {
  std::mt19937 random(seed);
  GridImage image{rows, columns, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool box = (column + shift) % 200 < 40 && row > rows / 8;
      const bool sky = row < rows / 4;
      const bool lost = random() % 100 == 0;
      const float noise_m = 0.01F * static_cast<float>(random() % 5);
      const float ground_m = 60.0F / static_cast<float>(1 + row) + noise_m;
      image.range_m.push_back(lost ? 0 : box ? 8.0F + noise_m : sky ? 0 : ground_m);
    }
  }
  return image;
}

ReferenceImage reference_of(const GridImage& image) {
  ReferenceImage reference{image.rows, image.columns, image.range_m, {}};
  for (std::size_t i = 0; i < image.range_m.size(); ++i) {
    reference.hits.push_back(image.range_m[i] > 0 ? kWarpedHit | kPreviousHit
                             : i % 3 == 0         ? kWarpedFilled
                                                  : 0);
  }
  return reference;
}

struct Coded {
  std::vector<CodedBand> bands;
  GridImage image;  // as the decoder will have it
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const CodedBand& band : bands) sum += band.mask.size() + band.ranges.size();
    return sum;
  }
};

Coded encode(const GridImage& image, const CodingKind& kind, const RangeQuantiser& quantiser,
             const ReferenceImage& reference, std::span<const float> known_m = {}) {
  Coded coded{{}, image};
  for (const Band& band : choose_bands(image, quantiser.step_m)) {
    BandState state = state_from_priors(kind, quantiser.step_m, band);
    coded.bands.push_back(encode_band({kind, quantiser, &reference, {}, known_m}, band, coded.image, state));
  }
  return coded;
}

// `original`: its bands are the stream's.
GridImage decode(const std::vector<CodedBand>& coded, const GridImage& original, const CodingKind& kind,
                 const RangeQuantiser& quantiser, const ReferenceImage& reference,
                 std::span<const float> known_m = {}) {
  GridImage image{original.rows, original.columns, std::vector<float>(original.range_m.size())};
  const auto bands = choose_bands(original, quantiser.step_m);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    BandState state = state_from_priors(kind, quantiser.step_m, bands[b]);
    const auto result = decode_band({kind, quantiser, &reference, {}, known_m}, bands[b], coded[b].mask,
                                    coded[b].ranges, image, state);
    EXPECT_TRUE(result) << result.error().message;
  }
  return image;
}

void check_round_trip(const GridImage& image, const CodingKind& kind, const RangeQuantiser& quantiser,
                      const ReferenceImage& reference) {
  const Coded coded = encode(image, kind, quantiser, reference);
  EXPECT_EQ(decode(coded.bands, image, kind, quantiser, reference).range_m, coded.image.range_m);
  for (std::size_t i = 0; i < image.range_m.size(); ++i) {
    ASSERT_EQ(coded.image.range_m[i] > 0, image.range_m[i] > 0) << i;
    ASSERT_NEAR(coded.image.range_m[i], image.range_m[i],
                0.5F * quantiser.step_m + 1e-6F * (1 + image.range_m[i]))
        << i;
  }
}

const std::vector<CodingKind> kKinds = {{false, Effort::fast},
                                        {false, Effort::balanced},
                                        {false, Effort::max},
                                        {true, Effort::balanced},
                                        {true, Effort::max}};

class BandSizes : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(BandSizes, ComeBackByEveryKindOfFrame) {
  const auto [rows, columns] = GetParam();
  const GridImage image = street(rows, columns, 1);
  const ReferenceImage reference = reference_of(street(rows, columns, 2, 3));
  for (const CodingKind& kind : kKinds) {
    SCOPED_TRACE(testing::Message() << "predicted " << kind.predicted << ", effort "
                                    << static_cast<int>(kind.effort));
    check_round_trip(image, kind, {kStepM, {}}, reference);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BandSizes,
                         testing::Combine(testing::Values(1, 2, 7, 8, 9, 64),
                                          testing::Values(1, 2, 7, 17, 18, 500)));

TEST(BandCoding, ALatticeIsKeptExactly) {
  GridImage image = street(20, 300, 1);
  RangeQuantiser quantiser{0.002F, {}};
  for (int row = 0; row < image.rows; ++row) {
    quantiser.lattice_phase_m.push_back(0.0001F * static_cast<float>(row));
    for (int column = 0; column < image.columns; ++column) {
      float& range_m = image.range_m[image.index(row, column)];
      if (range_m > 0) range_m = std::round(range_m / 0.002F) * 0.002F + quantiser.lattice_phase_m.back();
    }
  }
  const ReferenceImage reference = reference_of(street(20, 300, 2));
  for (const CodingKind& kind : kKinds) {
    const Coded coded = encode(image, kind, quantiser, reference);
    EXPECT_EQ(decode(coded.bands, image, kind, quantiser, reference).range_m, coded.image.range_m);
    for (std::size_t i = 0; i < image.range_m.size(); ++i)
      ASSERT_NEAR(coded.image.range_m[i], image.range_m[i], 2e-5F);
  }
}

TEST(BandCoding, SmallAndLargeStepsComeBack) {
  const GridImage image = street(24, 400, 5);
  const ReferenceImage reference = reference_of(street(24, 400, 6, 1));
  for (const float step_m : {0.001F, 0.002F, 0.006F, 0.3F, 2.0F}) {
    for (const CodingKind& kind : kKinds) check_round_trip(image, kind, {step_m, {}}, reference);
  }
}

TEST(BandCoding, NoiseComesBackWhateverTheRanges) {
  for (const std::uint32_t most_steps : {2'500'000U, (1U << 24) - 1}) {
    std::mt19937 random(7);
    GridImage image{40, 333, {}};
    for (int i = 0; i < image.rows * image.columns; ++i) {
      const float range_m =
          random() % 4 == 0 ? 0.011F : kStepM * static_cast<float>(1 + random() % most_steps);
      image.range_m.push_back(random() % 2 == 0 ? 0.0F : range_m);
    }
    const ReferenceImage reference = reference_of(image);
    for (const CodingKind& kind : kKinds) {
      const Coded coded = encode(image, kind, {kStepM, {}}, reference);
      EXPECT_EQ(decode(coded.bands, image, kind, {kStepM, {}}, reference).range_m, coded.image.range_m);
    }
  }
}

TEST(BandCoding, KnownRangesAreTakenAsTheyAre) {
  for (const int columns : {1, 60, 400}) {
    const GridImage image = street(21, columns, 3);
    const ReferenceImage reference = reference_of(street(21, columns, 4, 1));
    // One in three, and all of every seventh stretch of columns.
    std::vector<float> known_m(image.range_m.size());
    for (std::size_t i = 0; i < known_m.size(); ++i) {
      const bool known = i % 3 == 0 || i % static_cast<std::size_t>(columns) / 40 % 7 == 1;
      known_m[i] = known ? image.range_m[i] + 0.003F : 0;
      if (image.range_m[i] <= 0) known_m[i] = 5;  // a surface in front of which nothing was seen
    }
    for (const CodingKind& kind : kKinds) {
      const Coded coded = encode(image, kind, {kStepM, {}}, reference, known_m);
      EXPECT_EQ(decode(coded.bands, image, kind, {kStepM, {}}, reference, known_m).range_m,
                coded.image.range_m);
      for (std::size_t i = 0; i < known_m.size(); ++i) {
        const float range_m = image.range_m[i];
        if (range_m <= 0 || known_m[i] <= 0) {
          ASSERT_NEAR(coded.image.range_m[i], range_m, 0.5F * kStepM + 1e-6F * (1 + range_m)) << i;
        } else {
          ASSERT_EQ(coded.image.range_m[i], known_m[i]) << i;
        }
      }
    }
  }
}

TEST(BandCoding, AStreetCostsLittleAndAReferenceHelps) {
  const GridImage image = street(64, 2000, 1);
  const ReferenceImage none;
  const Coded fast = encode(image, {false, Effort::fast}, {kStepM, {}}, none);
  const Coded alone = encode(image, {false, Effort::balanced}, {kStepM, {}}, none);
  const Coded predicted = encode(image, {true, Effort::balanced}, {kStepM, {}}, reference_of(image));
  const Coded with_all = encode(image, {true, Effort::max}, {kStepM, {}}, reference_of(image));
  // 1 % of the returns are lost at random: 0.081 bits a cell are the least of the mask.
  for (const Coded* coded : {&alone, &fast}) {
    std::size_t mask_bytes = 0;
    for (const CodedBand& band : coded->bands) mask_bytes += band.mask.size();
    EXPECT_LT(static_cast<double>(mask_bytes) * 8, 0.12 * 64 * 2000);
  }
  EXPECT_LT(alone.bytes(), fast.bytes());
  EXPECT_LT(predicted.bytes(), alone.bytes());
  EXPECT_LT(with_all.bytes(), alone.bytes());  // (which of the two is ahead real sweeps must say)
}

TEST(BandCoding, ABiasOfEachRowOfTheReferenceCostsLittle) {
  // Rough, so that cells around say little; noise, so that a single difference to the reference says little.
  constexpr int kRows = 64, kColumns = 2000;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> roughness_m(0, 2), noise_m(-kStepM, kStepM);
  GridImage image{kRows, kColumns, {}}, same{kRows, kColumns, {}}, biased{kRows, kColumns, {}};
  for (int row = 0; row < kRows; ++row) {
    const float bias_m = kStepM * static_cast<float>(row % 5 - 2);
    for (int column = 0; column < kColumns; ++column) {
      const float range_m = 10 + roughness_m(random);
      image.range_m.push_back(range_m + noise_m(random));
      same.range_m.push_back(range_m + noise_m(random));
      biased.range_m.push_back(same.range_m.back() + bias_m);
    }
  }
  for (const Effort effort : {Effort::balanced, Effort::max}) {
    const auto bytes = [&](const GridImage& reference) {
      return static_cast<double>(
          encode(image, {true, effort}, {kStepM, {}}, reference_of(reference)).bytes());
    };
    EXPECT_LT(bytes(biased), 1.05 * bytes(same));
  }
}

TEST(BandCoding, AnyBytesDecodeToSomeImageOrEndTooSoon) {
  std::mt19937 random(11);
  const GridImage size = street(64, 500, 1);
  const ReferenceImage reference = reference_of(size);
  for (const CodingKind& kind : kKinds) {
    for (int trial = 0; trial < 6; ++trial) {
      std::vector<std::uint8_t> mask(4000), ranges(40000);
      for (auto* bytes : {&mask, &ranges}) {
        for (auto& byte : *bytes)
          byte = static_cast<std::uint8_t>(trial == 0 ? 0 : trial == 1 ? 0xFF : random());
      }
      GridImage image{size.rows, size.columns, std::vector<float>(size.range_m.size())};
      const RangeQuantiser quantiser{trial % 2 == 0 ? kStepM : 0.002F, {}};
      const Band whole{0, size.rows};
      BandState state = state_from_priors(kind, quantiser.step_m, whole);
      // The sanitizers watch the indices and the arithmetic.
      (void)decode_band({kind, quantiser, &reference}, whole, mask, ranges, image, state);
      for (const float range_m : image.range_m) ASSERT_TRUE(std::isfinite(range_m));
    }
  }
}

}  // namespace
}  // namespace pointreel
