#include "sensor/row_walk.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pointreel {
namespace {

constexpr std::uint32_t kRowColumns = 300;

struct TwoRows {
  SensorModel model;
  SweepGrid grid;
  std::vector<std::uint8_t> occupied;
  std::vector<float> range_m;
};

// Two rows, of which the second has `returns` per mille of its cells.
TwoRows two_rows(std::uint32_t seed, OrderKind kind, bool descending, int returns, float nearest_m) {
  std::mt19937 random(seed);
  TwoRows sweep;
  for (const double side_offset_m : {0.0, 0.026}) {
    RowModel row;
    row.slope = 0.1;
    row.azimuth_rad = 0.7 * static_cast<double>(random() % 1000) / 1000;
    row.side_offset_m = side_offset_m;
    sweep.model.rows.push_back(row);
  }
  sweep.grid.ticks_per_turn = 2 * kRowColumns;
  for (std::uint32_t c = 0; c < kRowColumns; ++c) sweep.grid.column_tick.push_back(2 * c + random() % 2);
  sweep.grid.order.kind = kind;
  sweep.grid.order.descending = descending;
  sweep.grid.order.seam_tick = static_cast<std::uint32_t>(random() % sweep.grid.ticks_per_turn);
  for (std::uint32_t cell = 0; cell < 2 * kRowColumns; ++cell) {
    const bool hit = static_cast<int>(random() % 1000) < (cell < kRowColumns ? 500 : returns);
    sweep.occupied.push_back(hit ? 1 : 0);
    sweep.range_m.push_back(hit ? nearest_m * (1 + static_cast<float>(random() % 4096) / 16) : 0);
  }
  return sweep;
}

// By the definition: sorted by azimuth from the seam, then by column.
std::vector<std::uint32_t> by_definition(const TwoRows& sweep, std::uint32_t row) {
  const SweepGrid& grid = sweep.grid;
  const RowModel& laser = sweep.model.rows[row];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
  for (std::uint32_t cell = row * kRowColumns; cell < (row + 1) * kRowColumns; ++cell) {
    if (sweep.occupied[cell] == 0) continue;
    std::uint32_t azimuth = azimuth_of_tick(grid.column_tick[cell % kRowColumns], grid.ticks_per_turn) +
                            row_turn(grid.order.kind, laser) -
                            azimuth_of_tick(grid.order.seam_tick, grid.ticks_per_turn);
    if (grid.order.kind == OrderKind::row_azimuth)
      azimuth += static_cast<std::uint32_t>(
          turned_by_side(static_cast<float>(laser.side_offset_m), sweep.range_m[cell] * cosine_of(laser)));
    cells.emplace_back(grid.order.descending ? ~azimuth : azimuth, cell);
  }
  std::sort(cells.begin(), cells.end());
  std::vector<std::uint32_t> result;
  for (const auto& [place, cell] : cells) result.push_back(cell);
  return result;
}

double turns_by_side(float side_m, float rho_m) {
  return turned_by_side(side_m, rho_m) / kWholeTurn;
}

TEST(RowWalk, TheSideOffsetTurnsByItsArcTangent) {
  for (const float side_m : {0.0F, 0.026F, -0.026F, 0.3F}) {
    for (float rho_m = 4 * std::fabs(side_m) + 0.01F; rho_m < 300; rho_m *= 1.3F) {
      const double turned = std::atan2(side_m, rho_m) / kTurn;
      const double series = std::pow(side_m / rho_m, 7) / 7;  // what is left out
      EXPECT_NEAR(turns_by_side(side_m, rho_m), turned, 1e-7 * std::fabs(turned) + std::fabs(series) + 1e-9)
          << side_m << ' ' << rho_m;
    }
  }
}

TEST(RowWalk, AnyRangeTurnsByLessThanAQuarter) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float side_m : {0.026F, -4.0F}) {
    for (const float rho_m :
         {0.0F, -1.0F, -kInfinity, 1e-30F, 1e30F, kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
      EXPECT_LT(std::fabs(turns_by_side(side_m, rho_m)), 0.14) << rho_m;
    }
    EXPECT_EQ(turns_by_side(side_m, kInfinity), 0);
  }
  EXPECT_EQ(turns_by_side(0, 0), 0);
}

RC_GTEST_PROP(RowWalk, PassesTheReturnsByAzimuthFromTheSeam, ()) {
  const auto kind = *rc::gen::element(OrderKind::row_azimuth, OrderKind::row_major, OrderKind::row_column);
  // None, one, some, all; ranges from where the side offset hardly matters to where it tosses the cells
  // about.
  const int returns = *rc::gen::element(0, 4, 500, 1000);
  const float nearest_m = *rc::gen::element(3.0F, 0.2F, 0.001F);
  const TwoRows sweep =
      two_rows(*rc::gen::arbitrary<std::uint32_t>(), kind, *rc::gen::arbitrary<bool>(), returns, nearest_m);
  RowWalk walk(sweep.occupied, sweep.range_m, sweep.model, sweep.grid);
  for (const std::uint32_t row : {1U, 0U, 1U}) {
    const auto expected = by_definition(sweep, row);
    std::vector<std::uint32_t> cells(expected.size() + 1, 12345);
    walk.list(row, cells.data());
    RC_ASSERT(cells.back() == 12345U);  // writes no further
    cells.pop_back();
    RC_ASSERT(cells == expected);
  }
}

}  // namespace
}  // namespace pointreel
