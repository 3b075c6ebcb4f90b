// ColumnFinder: which column of a sweep looks in a direction.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sensor/sweep_grid.h"

namespace pointreel {

// A turn in equal bins, and in each a straight line: SIMD code asks for many directions at once. Of two turns
// the first that has a direction answers.
class ColumnFinder {
 public:
  static constexpr float kNowhere = -1;  // any number up to this: farther than kMostBeyond from all columns

  // There must be a column.
  explicit ColumnFinder(const SweepGrid& grid) {
    const std::size_t columns = grid.column_count();
    const auto turn_of = [&](std::size_t c) {
      return static_cast<double>(grid.column_tick[c]) / grid.ticks_per_turn;
    };
    const double first_turn = turn_of(0), turns = turn_of(columns - 1) - first_turn;
    constexpr double kLoneColumnTurns = 1e-3;  // to each side
    const double mean_step = columns > 1 ? turns / static_cast<double>(columns - 1) : kLoneColumnTurns;
    bins_ = std::bit_ceil(static_cast<std::size_t>(std::clamp(4 / mean_step, kLeastBins, kMostBins)));
    at_start_.assign(bins_ + 1, kUnknown);
    per_bin_.assign(bins_ + 1, 0);
    for (std::size_t c = 0; c < columns; ++c) {
      const bool last = c + 1 == columns;
      const double here = turn_of(c);
      const double step = columns == 1 ? kLoneColumnTurns
                          : last       ? here - turn_of(c - 1)
                                       : turn_of(c + 1) - here;
      fill(c == 0 ? here - kMostBeyond * step : here, last ? here + kMostBeyond * step : here + step,
           static_cast<double>(c), here, step);
    }
    for (std::size_t bin = 0; bin < bins_; ++bin) {
      const float rise = at_start_[bin + 1] - at_start_[bin];
      if (at_start_[bin] > kNowhere && rise > 0) per_bin_[bin] = rise;
    }
  }

  // How `bins()` times the turns, in [0, 1], become columns: that of the bin's start and the rise within it.
  // Below 0 but not nowhere is a hair before the first column.
  std::size_t bins() const { return bins_; }
  const float* at_start() const { return at_start_.data(); }
  const float* per_bin() const { return per_bin_.data(); }

  // The column nearest to an azimuth of `turn` turns, in [0, 1]; negative: none is near.
  std::int32_t nearest(float turn, std::int32_t columns) const {
    const float place = turn * static_cast<float>(bins_);
    const auto bin = static_cast<std::size_t>(place);
    const float column = at_start_[bin] + (place - static_cast<float>(bin)) * per_bin_[bin];
    if (column <= kNowhere) return -1;
    return std::min(columns - 1, static_cast<std::int32_t>(std::max(column, 0.0F) + 0.5F));
  }

 private:
  static constexpr double kLeastBins = 1024, kMostBins = 65536;
  static constexpr double kMostBeyond = 0.6;
  static constexpr float kUnknown = -1e6F;

  // Bins that start in [from_turn, to_turn), of two turns.
  void fill(double from_turn, double to_turn, double column, double at_turn, double step) {
    const auto bins = static_cast<double>(bins_);
    for (auto bin = static_cast<std::size_t>(std::ceil(std::max(0.0, from_turn * bins))); bin <= 2 * bins_;
         ++bin) {
      const double turn = static_cast<double>(bin) / bins;
      if (turn >= to_turn) return;
      const auto place = static_cast<float>(column + (turn - at_turn) / step);
      if (bin <= bins_) at_start_[bin] = place;
      if (bin >= bins_ && at_start_[bin - bins_] < 0) at_start_[bin - bins_] = place;
    }
  }

  std::size_t bins_ = 0;
  std::vector<float> at_start_, per_bin_;
};

}  // namespace pointreel
