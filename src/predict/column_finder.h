// ColumnFinder: which column of a sweep looks in a direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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

  // The column at an azimuth of `turn` turns, in [0, 1], as a number between its neighbours; negative: it
  // lies farther than kMostBeyond columns from all. Of two turns the first that has it. There must be a
  // column.
  float position(float turn) const {
    const float first_turn = turn_of_column_.front();
    const float in_first = position_of(turn);
    if (in_first >= 0 && turn >= first_turn) return in_first;
    const float in_second = position_of(turn + 1);
    return in_second >= 0 ? in_second : in_first;
  }

  // The column nearest to that of another sweep; negative: none is near.
  std::int32_t nearest_to(const ColumnFinder& other, std::size_t column) const {
    float turn = other.turn_of_column_[column];
    turn -= turn >= 1 ? 1.0F : 0.0F;
    const float found = position(turn);
    const auto last = static_cast<std::int32_t>(turn_of_column_.size()) - 1;
    return found < 0 ? -1 : std::min(last, static_cast<std::int32_t>(found + 0.5F));
  }

 private:
  static constexpr int kBinsPerTurn = 8192;  // KITTI has 2,160 columns in a turn
  static constexpr float kMostBeyond = 0.6F;

  // The same for a turn in [0, 2]; a hair before the first column is that column.
  float position_of(float turn) const {
    std::size_t c = first_of_bin_[static_cast<std::size_t>(static_cast<std::int32_t>(turn * kBinsPerTurn))];
    while (c + 1 < turn_of_column_.size() && turn_of_column_[c + 1] <= turn) ++c;
    const bool last = c + 1 == turn_of_column_.size();
    if (last && c == 0) return std::fabs(turn - turn_of_column_[0]) < kLoneColumnTurns ? 0.0F : -1.0F;
    const float step =
        last ? turn_of_column_[c] - turn_of_column_[c - 1] : turn_of_column_[c + 1] - turn_of_column_[c];
    const float beyond = (turn - turn_of_column_[c]) / step;
    if (beyond < -kMostBeyond || (last && beyond > kMostBeyond)) return -1;
    return static_cast<float>(c) + (beyond > 0 ? beyond : 0);
  }

  static constexpr float kLoneColumnTurns = 1e-3F;

  std::vector<float> turn_of_column_;
  std::vector<std::uint16_t> first_of_bin_;  // columns: at most 65536
};

}  // namespace pointreel
