// Weights of the cells around a cell in its local fits: they fall with the distance.
#pragma once

namespace pointreel {

struct FitKernels {
  static constexpr int kHere = 8, kAbove = 8;  // cells of the row itself, and of each of the two rows above
  static constexpr int kFirstHere = -8;        // column of the first one seen from the cell
  static constexpr int kFirstAbove = -4;
  static constexpr float kColumnsPerRow = 3;  // rows are farther apart than columns on most sensors

  float plane_here[kHere] = {}, plane_above[kAbove] = {}, plane_above2[kAbove] = {};
  float line[kHere] = {};

  constexpr FitKernels() {
    for (int i = 0; i < kHere; ++i) {
      plane_here[i] = plane_weight(static_cast<float>(i + kFirstHere), 0);
      line[i] = 1 / (1 - 0.3F * static_cast<float>(i + kFirstHere));
    }
    for (int i = 0; i < kAbove; ++i) {
      plane_above[i] = plane_weight(static_cast<float>(i + kFirstAbove), 1);
      plane_above2[i] = plane_weight(static_cast<float>(i + kFirstAbove), 2);
    }
  }

 private:
  static constexpr float plane_weight(float columns, float rows) {
    return 1 / (1 + 0.12F * columns * columns + rows * rows);
  }
};

inline constexpr FitKernels kFitKernels;

}  // namespace pointreel
