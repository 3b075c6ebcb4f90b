// The residual map: ranges of the cells that no plane holds, predicted from everything known around them.
#pragma once

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
      : coder_(coder), step_m_(residual_step_m), key_(key) {}

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

    float lowest = 1e30F, highest = 0, sum = 0, weight = 0;
    const auto take = [&](float range_m, float w) {
      const bool known = range_m > 0;
      lowest = known && range_m < lowest ? range_m : lowest;
      highest = range_m > highest ? range_m : highest;
      sum += w * range_m;  // unknown ranges are 0
      weight += known ? w : 0.0F;
    };
    take(left, 2);
    take(here[after], 2);  // cells to the right and below are known where planes hold them
    if (above != nullptr) {
      take(above[column], 1);
      take(above[before], 0.5F);
      take(above[after], 0.5F);
    }
    if (below != nullptr) take(below[column], 1);
    if (key_ != nullptr) {
      const int key_row = row + decoded.first_row - key_->first_row;
      if (key_row >= 0 && key_row < key_->rows) take(key_->at(key_row, column), 2);
    }
    if (weight == 0) {
      context = kNothingKnown;
      return kUsualRange_m;
    }
    const double spread_steps = (highest - lowest) / step_m_;
    context = 0;
    for (const double border : {0.25, 0.5, 1.0, 2.0, 4.0, 10.0, 30.0}) context += spread_steps >= border;
    return left > 0 ? left : sum / weight;
  }

  static constexpr float kNearest_m = 0.001f;
  static constexpr double kUsualRange_m = 10;
  static constexpr unsigned kNothingKnown = 8;
  static constexpr unsigned kContexts = 9;

  Coder& coder_;
  double step_m_;
  const RangeImage* key_;
  AdaptiveInteger residual_[kContexts];
  AdaptiveByte raw_[4];
};

}  // namespace pointreel
