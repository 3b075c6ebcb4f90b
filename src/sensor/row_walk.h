// RowWalk: the cells of one row in the order in which the sensor passes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Angles as fractions of a turn in 32 bits: sums wrap around by themselves, and no rounding differs.
inline constexpr double kWholeTurn = 4294967296.0;

inline std::uint32_t azimuth_of_tick(std::uint32_t tick, std::uint32_t ticks_per_turn) {
  return static_cast<std::uint32_t>((std::uint64_t{tick % ticks_per_turn} << 32) / ticks_per_turn);
}

inline std::uint32_t azimuth_of_row(const RowModel& row) {
  const double part = row.azimuth_rad / (2 * kPi) * kWholeTurn;  // within half a turn
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(part + (part < 0 ? -0.5 : 0.5)));
}

// What the azimuth that orders a row is, more than that of its columns.
inline std::uint32_t row_turn(OrderKind kind, const RowModel& row) {
  return kind == OrderKind::row_column ? 0 : azimuth_of_row(row);
}

// How far the side offset turns a point at this range, if there is one; any range will do.
inline std::int32_t turned_by_side(float side_m, float rho_m) {
  constexpr auto kPerRad = static_cast<float>(kWholeTurn / (2 * kPi));
  return static_cast<std::int32_t>(fast_atan2(side_m, rho_m > 0 ? rho_m : 0.0F) * kPerRad);
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
        column_(grid.column_count() + 1),
        azimuth_here_(grid.column_count() + 1),
        range_here_m_(grid.column_count() + 1),
        place_(grid.column_count() + 1),
        keys_(grid.column_count()) {
    azimuth_.reserve(grid.column_count());
    for (const std::uint32_t tick : grid.column_tick)
      azimuth_.push_back(azimuth_of_tick(tick, grid.ticks_per_turn));
  }

  // As many of them as the row has.
  void list(std::uint32_t row, std::uint32_t* cells) {
    const auto columns = static_cast<std::uint32_t>(azimuth_.size());
    const std::uint32_t first_cell = row * columns;
    const std::size_t taken = gather(first_cell, columns);
    find_places(model_.rows[row], taken);
    // In the direction of the walk they ascend but for one step back, at the seam.
    for (std::size_t k = 0; k < taken; ++k) keys_[k] = (std::uint64_t{place_[k]} << 32) | column_[k];
    const auto keys = std::span(keys_).first(taken);
    begin_at_seam(keys);
    sort_nearly_sorted(keys);
    for (std::size_t k = 0; k < taken; ++k) cells[k] = first_cell + static_cast<std::uint32_t>(keys[k]);
  }

 private:
  // The row's occupied cells in the direction of the walk, as many as it returns.
  std::size_t gather(std::uint32_t first_cell, std::uint32_t columns) {
    const std::uint8_t* occupied = &occupied_[first_cell];
    const float* range_m = &range_m_[first_cell];
    std::size_t taken = 0;
    const auto take = [&](std::uint32_t c) {
      column_[taken] = c;
      azimuth_here_[taken] = azimuth_[c];
      range_here_m_[taken] = range_m[c];
      taken += occupied[c];  // branches on single cells would be mispredicted
    };
    if (order_.descending) {
      for (std::uint32_t c = columns; c-- > 0;) take(c);
    } else {
      for (std::uint32_t c = 0; c < columns; ++c) take(c);
    }
    return taken;
  }

  void find_places(const RowModel& laser, std::size_t count) {
    const std::uint32_t turn = row_turn(order_.kind, laser) - seam_;
    const std::uint32_t flip = order_.descending ? 0xffffffff : 0;
    std::uint32_t* place = place_.data();
    const std::uint32_t* azimuth = azimuth_here_.data();
    if (order_.kind != OrderKind::row_azimuth) {
      for (std::size_t k = 0; k < count; ++k) place[k] = (azimuth[k] + turn) ^ flip;
      return;
    }
    const float cosine = cosine_of(laser);
    const auto side_m = static_cast<float>(laser.side_offset_m);
    const float* range_m = range_here_m_.data();
    for (std::size_t k = 0; k < count; ++k) {
      const auto turned_by = static_cast<std::uint32_t>(turned_by_side(side_m, range_m[k] * cosine));
      place[k] = (azimuth[k] + turn + turned_by) ^ flip;
    }
  }

  // Where the place falls by more than half a turn.
  static void begin_at_seam(std::span<std::uint64_t> keys) {
    constexpr std::uint64_t kHalfTurn = std::uint64_t{1} << 63;
    for (std::size_t k = 1; k < keys.size(); ++k) {
      if (keys[k - 1] < kHalfTurn || keys[k] > keys[k - 1] - kHalfTurn) continue;
      std::rotate(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(k), keys.end());
      return;
    }
  }

  // By insertion while that is cheap, which hostile ranges may not let it be.
  static void sort_nearly_sorted(std::span<std::uint64_t> keys) {
    std::size_t work = 8 * keys.size();
    for (std::size_t i = 1; i < keys.size(); ++i) {
      const std::uint64_t inserted = keys[i];
      std::size_t place = i;
      for (; place > 0 && inserted < keys[place - 1]; --place) {
        keys[place] = keys[place - 1];
        if (--work == 0) {
          keys[place - 1] = inserted;
          std::sort(keys.begin(), keys.end());
          return;
        }
      }
      keys[place] = inserted;
    }
  }

  std::span<const std::uint8_t> occupied_;
  std::span<const float> range_m_;
  const SensorModel& model_;
  PointOrder order_;
  std::uint32_t seam_;
  std::vector<std::uint32_t> azimuth_;  // of each column
  // Of the row's cells in the direction of the walk, and one to spare.
  std::vector<std::uint32_t> column_, azimuth_here_;
  std::vector<float> range_here_m_;
  std::vector<std::uint32_t> place_;  // from the seam in the walk's direction
  std::vector<std::uint64_t> keys_;
};

}  // namespace pointreel
