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
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(range_m);
    std::uint32_t coded = 0;
    for (int byte = 0; byte < 4; ++byte) {
      coded |=
          static_cast<std::uint32_t>(raw_[byte].code(coder_, static_cast<std::uint8_t>(bits >> (8 * byte))))
          << (8 * byte);
    }
    const float range = std::bit_cast<float>(coded);
    return range > 0 ? range : kNearest_m;  // NaN from damaged bytes, too
  }

  double predict(const RangeImage& decoded, int row, int column, unsigned& context) const {
    const auto known = [&](int r, int c) -> double {
      if (r < 0 || r >= decoded.rows) return 0;
      if (c < 0) c += decoded.columns;
      if (c >= decoded.columns) c -= decoded.columns;
      return decoded.at(r, c);
    };
    const double left = known(row, column - 1), up = known(row - 1, column);
    const double right = known(row, column + 1), down = known(row + 1, column);
    const double up_left = known(row - 1, column - 1), up_right = known(row - 1, column + 1);
    double key_range = 0;
    if (key_ != nullptr) {
      const int key_row = row + decoded.first_row - key_->first_row;
      if (key_row >= 0 && key_row < key_->rows) key_range = key_->at(key_row, column);
    }
    double sum = 0, weight = 0, lowest = 1e30, highest = 0;
    const auto take = [&](double range, double w) {
      if (!(range > 0)) return;
      sum += w * range;
      weight += w;
      lowest = std::min(lowest, range);
      highest = std::max(highest, range);
    };
    take(left, 2);
    take(right, 2);
    take(up, 1);
    take(down, 1);
    take(up_left, 0.5);
    take(up_right, 0.5);
    take(key_range, 2);
    if (weight == 0) {
      take(known(row, column - 2), 1);
      take(known(row - 2, column), 1);
    }
    if (weight == 0) {
      context = kContexts - 1;
      return 10.0;
    }
    const double spread = (highest - lowest) / step_m_;
    context = spread < 0.25  ? 0
              : spread < 0.5 ? 1
              : spread < 1   ? 2
              : spread < 2   ? 3
              : spread < 4   ? 4
              : spread < 10  ? 5
              : spread < 30  ? 6
                             : 7;
    if (left > 0) return left;
    return sum / weight;
  }

  static constexpr float kNearest_m = 0.001f;
  static constexpr unsigned kContexts = 9;

  Coder& coder_;
  double step_m_;
  const RangeImage* key_;
  AdaptiveInteger residual_[kContexts];
  AdaptiveByte raw_[4];
};

}  // namespace pointreel
