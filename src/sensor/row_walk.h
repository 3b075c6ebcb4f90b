// RowWalk: the cells of one row in the order in which the sensor passes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/first_where.h"
#include "base/simd_loops.h"
#include "base/trigonometry.h"
#include "sensor/sensor_model.h"
#include "sensor/side_turn.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Angles as fractions of a turn in 32 bits: sums wrap around by themselves, and no rounding differs.
inline constexpr double kWholeTurn = 4294967296.0;

inline std::uint32_t azimuth_of_tick(std::uint32_t tick, std::uint32_t ticks_per_turn) {
  return static_cast<std::uint32_t>((std::uint64_t{tick % ticks_per_turn} << 32) / ticks_per_turn);
}

inline std::uint32_t azimuth_of_row(const RowModel& row) {
  const double part = row.azimuth_rad / kTurn * kWholeTurn;  // within half a turn
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(part + (part < 0 ? -0.5 : 0.5)));
}

// What the azimuth that orders a row is, more than that of its columns.
inline std::uint32_t row_turn(OrderKind kind, const RowModel& row) {
  return kind == OrderKind::row_column ? 0 : azimuth_of_row(row);
}

// How far the side offset turns a point at this range, if there is one: the arc tangent's series, which need
// not be right near the axis. Any range will do.
inline std::int32_t turned_by_side(float side_m, float rho_m) {
  constexpr auto kPerRad = static_cast<float>(kWholeTurn / kTurn);
  const float least_m = std::fabs(side_m) + 1e-9F;
  return static_cast<std::int32_t>(arc_tangent_series(side_m / (rho_m > least_m ? rho_m : least_m)) *
                                   kPerRad);
}

inline float cosine_of(const RowModel& row) {
  return static_cast<float>(1 / std::sqrt(1 + row.slope * row.slope));
}

// Lists the occupied cells of one row, once around from the seam: by azimuth from there, modulo a turn, then
// by column.
class RowWalk {
 public:
  RowWalk(std::span<const std::uint8_t> occupied, std::span<const float> range_m, const SensorModel& model,
          const SweepGrid& grid)
      : occupied_(occupied),
        range_m_(range_m),
        model_(model),
        order_(grid.order),
        seam_(azimuth_of_tick(grid.order.seam_tick, grid.ticks_per_turn)),
        place_of_column_(grid.column_count()),
        place_(grid.column_count() + 1),
        column_(grid.column_count() + 1) {
    azimuth_.reserve(grid.column_count());
    for (const std::uint32_t tick : grid.column_tick)
      azimuth_.push_back(azimuth_of_tick(tick, grid.ticks_per_turn));
  }

  // As many of them as the row has.
  POINTREEL_SIMD_LOOPS void list(std::uint32_t row, std::uint32_t* cells) {
    const auto first_cell = static_cast<std::uint32_t>(row * azimuth_.size());
    find_places(model_.rows[row], &range_m_[first_cell]);
    const std::size_t taken = gather(&occupied_[first_cell]);
    // In the direction of the walk they ascend but for one step back, at the seam.
    begin_at_seam(taken);
    sort_nearly_sorted(taken);
    for (std::size_t k = 0; k < taken; ++k) cells[k] = first_cell + column_[k];
  }

 private:
  // Of the row's cells, from the seam in the direction of the walk.
  void find_places(const RowModel& laser, const float* range_m) {
    const std::size_t columns = azimuth_.size();
    const std::uint32_t turn = row_turn(order_.kind, laser) - seam_;
    const std::uint32_t flip = order_.descending ? 0xffffffff : 0;
    const std::uint32_t* azimuth = azimuth_.data();
    std::uint32_t* place = place_of_column_.data();
    if (order_.kind != OrderKind::row_azimuth) {
      for (std::size_t c = 0; c < columns; ++c) place[c] = (azimuth[c] + turn) ^ flip;
      return;
    }
    const float cosine = cosine_of(laser);
    const auto side_m = static_cast<float>(laser.side_offset_m);
    for (std::size_t c = 0; c < columns; ++c) {
      const auto turned_by = static_cast<std::uint32_t>(turned_by_side(side_m, range_m[c] * cosine));
      place[c] = (azimuth[c] + turn + turned_by) ^ flip;
    }
  }

  // The occupied cells in the direction of the walk, as many as it returns.
  std::size_t gather(const std::uint8_t* occupied) {
    const auto columns = static_cast<std::uint32_t>(azimuth_.size());
    std::size_t taken = 0;
    const auto take = [&](std::uint32_t c) {
      place_[taken] = place_of_column_[c];
      column_[taken] = c;
      taken += occupied[c];  // branches on single cells would be mispredicted
    };
    if (order_.descending) {
      for (std::uint32_t c = columns; c-- > 0;) take(c);
    } else {
      for (std::uint32_t c = 0; c < columns; ++c) take(c);
    }
    return taken;
  }

  // Where the place falls by more than half a turn.
  void begin_at_seam(std::size_t count) {
    constexpr std::uint32_t kHalfTurn = std::uint32_t{1} << 31;
    const std::uint32_t* place = place_.data();
    const std::size_t seam = first_where(1, count, [place](std::size_t k) {
      return static_cast<int>(place[k - 1] >= kHalfTurn) &
             static_cast<int>(place[k] <= place[k - 1] - kHalfTurn);
    });
    if (seam == count) return;
    const auto rotate = [=](std::vector<std::uint32_t>& values) {
      const auto begin = values.begin();
      std::rotate(begin, begin + static_cast<std::ptrdiff_t>(seam),
                  begin + static_cast<std::ptrdiff_t>(count));
    };
    rotate(place_);
    rotate(column_);
  }

  // By place, then column: by insertion while that is cheap, which hostile ranges may not let it be.
  void sort_nearly_sorted(std::size_t count) {
    const std::uint32_t* place = place_.data();
    const auto falls = [place](std::size_t k) { return static_cast<int>(place[k] <= place[k - 1]); };
    std::size_t work = 8 * count;
    for (std::size_t i = first_where(1, count, falls); i < count; i = first_where(i + 1, count, falls)) {
      const std::size_t moved = insert(i, work);
      if (moved == work) return sort_any(count);
      work -= moved;
    }
  }
  // Cell `i` among those before it, which are sorted; by how far, at most `most`.
  std::size_t insert(std::size_t i, std::size_t most) {
    const std::uint64_t inserted = key(i);
    std::size_t to = i;
    for (; to > 0 && i - to < most && inserted < key(to - 1); --to) {
      place_[to] = place_[to - 1];
      column_[to] = column_[to - 1];
    }
    place_[to] = static_cast<std::uint32_t>(inserted >> 32);
    column_[to] = static_cast<std::uint32_t>(inserted);
    return i - to;
  }
  void sort_any(std::size_t count) {
    std::vector<std::uint64_t> keys(count);
    for (std::size_t k = 0; k < count; ++k) keys[k] = key(k);
    std::sort(keys.begin(), keys.end());
    for (std::size_t k = 0; k < count; ++k) column_[k] = static_cast<std::uint32_t>(keys[k]);
  }
  std::uint64_t key(std::size_t k) const { return (std::uint64_t{place_[k]} << 32) | column_[k]; }

  std::span<const std::uint8_t> occupied_;
  std::span<const float> range_m_;
  const SensorModel& model_;
  PointOrder order_;
  std::uint32_t seam_;
  std::vector<std::uint32_t> azimuth_;  // of each column
  // Of the row: by column; of its occupied cells in the direction of the walk, and one to spare.
  std::vector<std::uint32_t> place_of_column_, place_, column_;
};

}  // namespace pointreel
