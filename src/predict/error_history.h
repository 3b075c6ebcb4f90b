// Squared errors of the experts at the cells of a row and of the two above it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "predict/causal_canvas.h"
#include "predict/range_state.h"

namespace pointreel {

class ErrorHistory {
 public:
  explicit ErrorHistory(int columns) {
    for (std::size_t i = 0; i < kRows; ++i) {
      storage_[i].resize(static_cast<std::size_t>(columns + 2 * CausalCanvas::kMargin) * kExperts);
      rows_[i] = storage_[i].data() + CausalCanvas::kMargin * kExperts;
    }
  }
  void start_row() { std::rotate(rows_.begin(), rows_.end() - 1, rows_.end()); }

  // kExperts values a cell; finite also where nothing was ever stored. Columns from -kMargin on.
  float* at(std::size_t rows_back, int column) {
    return rows_[rows_back] + column * static_cast<std::ptrdiff_t>(kExperts);
  }
  const float* at(std::size_t rows_back, int column) const {
    return rows_[rows_back] + column * static_cast<std::ptrdiff_t>(kExperts);
  }

 private:
  static constexpr std::size_t kRows = 3;
  std::array<std::vector<float>, kRows> storage_;
  std::array<float*, kRows> rows_;  // the newest first
};

}  // namespace pointreel
