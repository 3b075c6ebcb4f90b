// ColumnFinder: which column of a sweep looks in a direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/trigonometry.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

class ColumnFinder {
 public:
  explicit ColumnFinder(const SweepGrid& grid) : turn_of_column_(grid.column_count()) {
    for (std::size_t c = 0; c < turn_of_column_.size(); ++c) {
      turn_of_column_[c] = static_cast<float>(static_cast<double>(grid.column_tick[c]) / grid.ticks_per_turn);
    }
    // For each bin the last column that begins before it, or the first.
    first_of_bin_.resize(2 * kBinsPerTurn + 1);
    std::size_t column = 0;
    for (std::size_t bin = 0; bin < first_of_bin_.size(); ++bin) {
      const float start = static_cast<float>(bin) / kBinsPerTurn;
      while (column + 1 < turn_of_column_.size() && turn_of_column_[column + 1] <= start) ++column;
      first_of_bin_[bin] = static_cast<std::uint16_t>(column);
    }
  }

  std::size_t size() const { return turn_of_column_.size(); }
  // Azimuth of the last column, in turns: at 1 or more the sweep covers more than a turn.
  float last_turn() const { return turn_of_column_.back(); }

  // The column at `turn`, in [0, 2), as a number between its neighbours: beyond the first and the last one by
  // at most one. There must be a column.
  float position(float turn) const {
    std::size_t c = first_of_bin_[static_cast<std::size_t>(static_cast<std::int32_t>(turn * kBinsPerTurn))];
    while (c + 1 < turn_of_column_.size() && turn_of_column_[c + 1] <= turn) ++c;
    if (c + 1 == turn_of_column_.size()) {
      if (c == 0) return 0;
      const float step = turn_of_column_[c] - turn_of_column_[c - 1];
      const float beyond = (turn - turn_of_column_[c]) / step;
      return static_cast<float>(c) + (beyond < 1 ? beyond : 1);
    }
    const float step = turn_of_column_[c + 1] - turn_of_column_[c];
    const float beyond = (turn - turn_of_column_[c]) / step;
    return static_cast<float>(c) + (beyond > -1 ? beyond : -1);
  }

 private:
  static constexpr int kBinsPerTurn = 8192;  // KITTI has 2,160 columns in a turn

  std::vector<float> turn_of_column_;
  std::vector<std::uint16_t> first_of_bin_;  // columns: at most 65536
};

}  // namespace pointreel
