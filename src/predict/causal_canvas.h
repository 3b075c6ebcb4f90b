// The cells of a band of rows as far as they are coded: what every prediction may look at.
#pragma once

#include <cstddef>
#include <vector>

namespace pointreel {

// Ranges and their inverses, 0 where there is no return or nothing is coded yet. Two empty rows above and
// kMargin empty cells on either side let neighbourhoods be read without looking for borders.
class CausalCanvas {
 public:
  static constexpr int kMargin = 8;
  static constexpr int kRowsAbove = 2;
  static constexpr float kSmallestRangeM = 1e-3F;  // of a return

  CausalCanvas(int rows, int columns)
      : stride_(static_cast<std::size_t>(columns + 2 * kMargin)),
        range_m_(stride_ * static_cast<std::size_t>(rows + kRowsAbove)),
        inverse_range_(range_m_.size()) {}

  // Index of a cell; neighbours are at -1, +1, -stride() and so on.
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row + kRowsAbove) * stride_ + static_cast<std::size_t>(column + kMargin);
  }
  std::size_t stride() const { return stride_; }
  const float* range_m(std::size_t index) const { return &range_m_[index]; }
  const float* inverse_range(std::size_t index) const { return &inverse_range_[index]; }

  void set(std::size_t index, float range_m) {
    range_m_[index] = range_m;
    inverse_range_[index] = 1 / range_m;
  }

 private:
  std::size_t stride_;
  std::vector<float> range_m_;
  std::vector<float> inverse_range_;
};

}  // namespace pointreel
