// How the rows of an image are divided among threads.
#include "predict/bands.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace pointreel {
namespace {

int rows_of(const std::vector<Band>& bands) {
  int rows = 0;
  for (const Band& band : bands) {
    EXPECT_EQ(band.first_row, rows);
    EXPECT_GT(band.rows, 0);
    rows += band.rows;
  }
  return rows;
}

GridImage flat(int rows, int columns) {
  return {rows, columns,
          std::vector<float>(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), 5)};
}

TEST(Bands, HaveAboutSeventyThousandCells) {
  EXPECT_EQ(choose_bands(flat(16, 1800), 0.04F).size(), 1U);
  EXPECT_EQ(choose_bands(flat(64, 2160), 0.04F).size(), 2U);
  EXPECT_EQ(choose_bands(flat(128, 2048), 0.04F).size(), 4U);
  EXPECT_EQ(choose_bands(flat(3, 200'000), 0.04F).size(), 1U);  // a block of the wavefront at least
}

TEST(Bands, ShareTheWorkAmongThem) {
  // All alike: halves. Eight octaves a cell in the upper quarter: that is 10 units a cell against 2.
  GridImage image = flat(64, 2160);
  ASSERT_EQ(choose_bands(image, 0.04F).size(), 2U);
  EXPECT_EQ(choose_bands(image, 0.04F)[0].rows, 32);
  for (std::size_t i = 0; i < image.range_m.size() / 4; ++i) image.range_m[i] = i % 2 == 0 ? 5.0F : 50.0F;
  EXPECT_EQ(choose_bands(image, 0.04F)[0].rows, 16);
}

RC_GTEST_PROP(Bands, MakeUpTheImage, ()) {
  const int rows = *rc::gen::inRange(1, 200), columns = *rc::gen::inRange(1, 4000);
  GridImage image = flat(rows, columns);
  for (float& range_m : image.range_m) range_m = static_cast<float>(*rc::gen::inRange(0, 2)) * 7;
  const auto bands = choose_bands(image, 0.01F);
  RC_ASSERT(rows_of(bands) == rows);
  for (std::size_t b = 0; b + 1 < bands.size(); ++b) RC_ASSERT(bands[b].rows % 8 == 0);
}

}  // namespace
}  // namespace pointreel
