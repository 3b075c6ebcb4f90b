// The residual map: ranges of the cells that no plane holds, predicted from everything known around them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "entropy/adaptive_models.h"
#include "planes/plane_run.h"

namespace pointreel {

// Ranges of a step (closed loop: error at most half a step) or, with step 0, raw float32 as in the paper.
template <class Coder>
class ResidualCoder {
 public:
  ResidualCoder(Coder& coder, double residual_step_m, const RangeImage* key)
      : coder_(coder), step_m_(residual_step_m), key_(key) {
    // Spreads of the ranges around a cell, in steps, at which the models change.
    constexpr std::array<double, kNothingKnown - 1> kBorders = {0.25, 0.5, 1, 2, 4, 10, 30};
    for (std::size_t i = 0; i < kBorders.size(); ++i) {
      spread_borders_m_[i] = static_cast<float>(kBorders[i] * step_m_);
    }
  }

  // Codes every occupied cell whose `decoded` range is still 0, in raster order, and fills it in.
  // `image`: the source ranges (encoder) or anything with the same occupancy (decoder).
  void code(const RangeImage& image, RangeImage& decoded) {
    for (int row = 0; row < image.rows; ++row) {
      for (int column = 0; column < image.columns; ++column) {
        if (!image.occupied(row, column) || decoded.at(row, column) > 0) continue;
        decoded.at(row, column) =
            step_m_ > 0 ? code_stepped(image, decoded, row, column) : code_raw(image.at(row, column));
      }
      if constexpr (Coder::kDecodes) {
        if (coder_.overran()) return;
      }
    }
  }

 private:
  float code_stepped(const RangeImage& image, const RangeImage& decoded, int row, int column) {
    unsigned context = 0;
    const double predicted = predict(decoded, row, column, context);
    const double steps =
        Coder::kDecodes ? 0.0 : std::floor((image.at(row, column) - predicted) / step_m_ + 0.5);
    const std::int32_t coded = residual_[context].code(coder_, static_cast<std::int32_t>(steps));
    // Ranges are positive; rounding below zero happens only within half a step of the sensor.
    return std::max(kNearest_m, static_cast<float>(predicted + coded * step_m_));
  }

  float code_raw(float range_m) {
    const auto bits = std::bit_cast<std::uint32_t>(range_m);
    std::uint32_t coded = 0;
    for (int byte = 0; byte < 4; ++byte) {
      coded |=
          static_cast<std::uint32_t>(raw_[byte].code(coder_, static_cast<std::uint8_t>(bits >> (8 * byte))))
          << (8 * byte);
    }
    const auto range = std::bit_cast<float>(coded);
    return range > 0 ? range : kNearest_m;  // NaN from damaged bytes, too
  }

  // Predicted range, and how far apart the ranges around the cell are (context for the residual's models).
  double predict(const RangeImage& decoded, int row, int column, unsigned& context) const {
    const int before = column > 0 ? column - 1 : decoded.columns - 1;
    const int after = column + 1 < decoded.columns ? column + 1 : 0;
    const float* here = &decoded.range_m[decoded.index(row, 0)];
    const float* above = row > 0 ? here - decoded.columns : nullptr;
    const float* below = row + 1 < decoded.rows ? here + decoded.columns : nullptr;
    const float left = here[before];

    float lowest = 1e30F, highest = 0;
    const auto note = [&](float range_m) {
      lowest = range_m > 0 && range_m < lowest ? range_m : lowest;  // unknown ranges are 0
      highest = range_m > highest ? range_m : highest;
    };
    // Cells to the right and below are known where planes hold them.
    const float right = here[after];
    note(left);
    note(right);
    float up = 0, down = 0, up_left = 0, up_right = 0, in_key = 0;
    if (above != nullptr) up = above[column], up_left = above[before], up_right = above[after];
    if (below != nullptr) down = below[column];
    if (key_ != nullptr) {
      const int key_row = row + decoded.first_row - key_->first_row;
      if (key_row >= 0 && key_row < key_->rows) in_key = key_->at(key_row, column);
    }
    for (const float range_m : {up, down, up_left, up_right, in_key}) note(range_m);
    if (highest == 0) {
      context = kNothingKnown;
      return kUsualRange_m;
    }
    const float spread_m = highest - lowest;
    context = 0;
    for (const float border_m : spread_borders_m_) context += spread_m >= border_m;
    if (left > 0) return left;
    float sum = 0, weight = 0;
    const auto weigh = [&](float range_m, float w) {
      sum += w * range_m;
      weight += range_m > 0 ? w : 0.0F;
    };
    weigh(right, 2);
    weigh(in_key, 2);
    weigh(up, 1);
    weigh(down, 1);
    weigh(up_left, 0.5F);
    weigh(up_right, 0.5F);
    return sum / weight;
  }

  static constexpr float kNearest_m = 0.001f;
  static constexpr double kUsualRange_m = 10;
  static constexpr unsigned kNothingKnown = 8;
  static constexpr unsigned kContexts = 9;

  Coder& coder_;
  double step_m_;
  std::array<float, kNothingKnown - 1> spread_borders_m_{};
  const RangeImage* key_;
  AdaptiveInteger residual_[kContexts];
  AdaptiveByte raw_[4];
};

}  // namespace pointreel
