// Weights of the cells around a cell in its local fits: they fall with the distance.
#pragma once

namespace pointreel {

inline constexpr float kFitColumnsPerRow = 3;  // rows are farther apart than columns on most sensors

struct FitKernels {
  static constexpr int kHere = 8, kAbove = 8;  // cells: left, and of each of the two rows above
  static constexpr int kFirstHere = -8;        // column of the first one seen from the cell
  static constexpr int kFirstAbove = -(kAbove / 2);

  float here[kHere] = {}, above[kAbove] = {}, above2[kAbove] = {};

  constexpr FitKernels() {
    for (int i = 0; i < kHere; ++i) here[i] = 1 / (1 - 0.3F * static_cast<float>(i + kFirstHere));
    for (int i = 0; i < kAbove; ++i) {
      above[i] = weight_above(static_cast<float>(i + kFirstAbove), 1);
      above2[i] = weight_above(static_cast<float>(i + kFirstAbove), 2);
    }
  }

 private:
  static constexpr float weight_above(float columns, float rows) {
    return 1 / (1 + 0.12F * columns * columns + rows * rows);
  }
};

inline constexpr FitKernels kFitKernels;

}  // namespace pointreel
