// Weights of the cells around a cell in its local fits: they fall with the distance.
#pragma once

#include <cstddef>

namespace pointreel {

struct FitKernels {
  static constexpr std::size_t kLanes = 8;
  static constexpr int kFirstHere = -8;       // column of lane 0 seen from the cell, in its own row
  static constexpr int kFirstAbove = -4;      // and in the two rows above
  static constexpr float kColumnsPerRow = 3;  // rows are farther apart than columns on most sensors

  alignas(32) float x_here[kLanes] = {}, x_above[kLanes] = {};
  alignas(32) float plane_here[kLanes] = {}, plane_above[kLanes] = {}, plane_above2[kLanes] = {};
  alignas(32) float line[kLanes] = {};

  constexpr FitKernels() {
    for (std::size_t i = 0; i < kLanes; ++i) {
      x_here[i] = static_cast<float>(static_cast<int>(i) + kFirstHere);
      x_above[i] = static_cast<float>(static_cast<int>(i) + kFirstAbove);
      plane_here[i] = plane_weight(x_here[i], 0);
      plane_above[i] = plane_weight(x_above[i], 1);
      plane_above2[i] = plane_weight(x_above[i], 2);
      line[i] = 1 / (1 - 0.3F * x_here[i]);
    }
  }

 private:
  static constexpr float plane_weight(float columns, float rows) {
    return 1 / (1 + 0.12F * columns * columns + rows * rows);
  }
};

inline constexpr FitKernels kFitKernels;

}  // namespace pointreel
