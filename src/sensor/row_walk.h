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

// Appends the occupied cells of one row, once around from the seam.
class RowWalk {
 public:
  RowWalk(std::span<const std::uint8_t> occupied, std::span<const float> range_m, const SensorModel& model,
          const SweepGrid& grid)
      : occupied_(occupied),
        range_m_(range_m),
        model_(model),
        order_(grid.order),
        seam_(azimuth_of_tick(grid.order.seam_tick, grid.ticks_per_turn)),
        turned_by_(grid.column_count(), 0) {
    azimuth_.reserve(grid.column_count());
    for (const std::uint32_t tick : grid.column_tick)
      azimuth_.push_back(azimuth_of_tick(tick, grid.ticks_per_turn));
    keys_.resize(grid.column_count() + 1);
  }

  void append(std::uint32_t row, std::vector<std::uint32_t>& cells) {
    const RowModel& laser = model_.rows[row];
    const std::size_t columns = azimuth_.size();
    const std::size_t first_cell = row * columns;
    const std::uint32_t turn = row_turn(order_.kind, laser) - seam_;
    if (order_.kind == OrderKind::row_azimuth) find_turns(laser, range_m_.subspan(first_cell, columns));
    std::size_t taken = 0;
    const auto take = [&](std::size_t c) {
      const auto cell = static_cast<std::uint32_t>(first_cell + c);
      keys_[taken] = key_of(azimuth_[c] + turn, turned_by_[c], cell);
      taken += occupied_[cell] != 0 ? 1 : 0;  // branches on single cells would be mispredicted
    };
    // The columns ascend, but for one step back where they or the row pass the seam.
    std::size_t first = 0;
    for (std::size_t c = 1; c < columns; ++c) {
      if (azimuth_[c] + turn < azimuth_[first] + turn) first = c;
    }
    if (order_.descending) {
      for (std::size_t c = first; c-- > 0;) take(c);
      for (std::size_t c = columns; c-- > first;) take(c);
    } else {
      for (std::size_t c = first; c < columns; ++c) take(c);
      for (std::size_t c = 0; c < first; ++c) take(c);
    }
    const auto keys = std::span(keys_).first(taken);
    sort_nearly_sorted(keys);
    take_across_seam(keys);
    for (const std::uint64_t key : keys) cells.push_back(static_cast<std::uint32_t>(key) & kCellMask);
  }

 private:
  // Azimuth from the seam, which a side offset may carry to the other side of it, then the cell.
  static constexpr int kCellBits = 24;
  static constexpr std::uint32_t kCellMask = (1u << kCellBits) - 1;
  static_assert(kMaxCells <= std::size_t{1} << kCellBits);
  static constexpr std::uint64_t kSeam = std::uint64_t{1} << 33;
  static constexpr std::uint64_t kNextSeam = kSeam + (std::uint64_t{1} << 32);

  std::uint64_t key_of(std::uint32_t from_seam, std::int32_t turned_by, std::uint32_t cell) const {
    const std::int64_t azimuth = std::int64_t{from_seam} + turned_by;
    const std::int64_t place = order_.descending ? 0xffffffff - azimuth : azimuth;
    return ((kSeam + static_cast<std::uint64_t>(place)) << kCellBits) | cell;
  }

  // Sorted keys before the seam go to the end, those behind the next to the beginning.
  static void take_across_seam(std::span<std::uint64_t> keys) {
    constexpr std::uint64_t kFirst = kSeam << kCellBits;
    constexpr std::uint64_t kEnd = kNextSeam << kCellBits;
    if (keys.empty() || (keys.front() >= kFirst && keys.back() < kEnd)) return;
    const auto within = std::lower_bound(keys.begin(), keys.end(), kFirst);
    const auto behind = std::lower_bound(within, keys.end(), kEnd);
    for (auto key = keys.begin(); key != within; ++key) *key += kEnd - kFirst;
    for (auto key = behind; key != keys.end(); ++key) *key -= kEnd - kFirst;
    const auto before = within - keys.begin();
    const auto moved = std::rotate(keys.begin(), behind, keys.end());
    std::rotate(moved, moved + before, keys.end());
    sort_nearly_sorted(keys);
  }

  void find_turns(const RowModel& laser, std::span<const float> range_m) {
    const float cosine = cosine_of(laser);
    const auto side_m = static_cast<float>(laser.side_offset_m);
    std::int32_t* turned_by = turned_by_.data();
    for (std::size_t c = 0; c < range_m.size(); ++c)
      turned_by[c] = turned_by_side(side_m, range_m[c] * cosine);
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
  std::vector<std::uint32_t> azimuth_;   // of each column
  std::vector<std::int32_t> turned_by_;  // per column of the row
  std::vector<std::uint64_t> keys_;      // of the row's cells so far, and one to spare
};

}  // namespace pointreel
