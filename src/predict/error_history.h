// Squared errors of the experts at the cells of a row and of the two above it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "predict/causal_canvas.h"
#include "predict/range_state.h"

namespace pointreel {

class ErrorHistory {
 public:
  explicit ErrorHistory(int columns) {
    for (auto& row : rows_) row.resize(static_cast<std::size_t>(columns + 2 * CausalCanvas::kMargin));
  }
  void start_row() { newest_ = (newest_ + kRows - 1) % kRows; }

  // kExperts values; finite also where nothing was ever stored. Columns from -kMargin on.
  float* at(int rows_back, int column) { return cell(rows_back, column).data(); }
  const float* at(int rows_back, int column) const {
    return const_cast<ErrorHistory*>(this)->cell(rows_back, column).data();
  }

 private:
  static constexpr int kRows = 3;
  using Errors = std::array<float, kExperts>;
  Errors& cell(int rows_back, int column) {
    return rows_[static_cast<std::size_t>((newest_ + rows_back) % kRows)]
                [static_cast<std::size_t>(column + CausalCanvas::kMargin)];
  }
  std::array<std::vector<Errors>, kRows> rows_;
  int newest_ = 0;
};

}  // namespace pointreel
