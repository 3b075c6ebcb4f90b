// Keys of any size as differences to a prediction from points already known.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/wide_integer.h"
#include "fields/point_layout.h"

namespace pointreel {

enum class KeyPredictor : std::uint8_t {
  before,  // the previous point in the output's order: timestamps that come with the points
  left,    // the previous point of the row: rings
  above,   // the latest point of the column: timestamps of a column
  linear,  // 2 left - the one before it
  planar,  // left + above - above left
};
inline constexpr std::size_t kKeyPredictors = 5;

// Some consecutive points in the order of coding.
struct PointRun {
  std::size_t first, count;
};

// Calls visit(point, prediction) for the run's points in the order of coding; it returns the point's key.
// Nothing before the run is known. Predictions wrap around.
template <class Visit>
void predict_keys(KeyPredictor predictor, const PointLayout& layout, PointRun run, Visit visit) {
  if (predictor == KeyPredictor::before) {
    std::uint64_t before = 0;
    for (std::size_t i = run.first; i < run.first + run.count; ++i)
      before = visit(static_cast<std::uint32_t>(i), before);
    return;
  }
  std::vector<std::uint64_t> above(layout.columns() + 1, 0);  // [column + 1]: latest key in any row above
  std::uint64_t left = 0, left_before = 0, above_left = 0;
  std::uint32_t row = layout.rows();
  for (const PointLayout::Place& place : layout.raster().subspan(run.first, run.count)) {
    std::uint64_t& up = above[place.column + 1];
    if (place.row != row) {
      row = place.row;
      left = left_before = above_left = up;
    }
    const std::uint64_t prediction = predictor == KeyPredictor::left     ? left
                                     : predictor == KeyPredictor::above  ? up
                                     : predictor == KeyPredictor::linear ? 2 * left - left_before
                                                                         : left + up - above_left;
    const std::uint64_t key = visit(place.point, prediction);
    left_before = left;
    left = key;
    above_left = up;
    up = key;
  }
}

// Residuals by adaptive models chosen by the sizes of the two before; those of one field, kept between
// sweeps.
class ResidualModel {
 public:
  template <class Coder>
  void code(Coder& coder, KeyPredictor predictor, const PointLayout& layout, std::span<std::uint64_t> keys) {
    std::uint32_t size = 0, size_before = 0;
    const PointRun all = {0, layout.size()};
    predict_keys(predictor, layout, all, [&](std::uint32_t point, std::uint64_t prediction) {
      AdaptiveWideInteger& model = models_[size * kSizes + size_before];
      const std::uint64_t coded = model.code(coder, zigzag(keys[point] - prediction));
      size_before = size;
      size = size_class(coded);
      return keys[point] = prediction + unzigzag(coded);
    });
  }

 private:
  static constexpr std::uint32_t kSizes = 6;
  static std::uint32_t size_class(std::uint64_t coded) {
    const auto length = std::bit_width(coded);
    return length == 0 ? 0u : length <= 2 ? 1u : length <= 4 ? 2u : length <= 7 ? 3u : length <= 12 ? 4u : 5u;
  }

  std::vector<AdaptiveWideInteger> models_ =
      std::vector<AdaptiveWideInteger>(kSizes * kSizes, AdaptiveWideInteger(6));
};

}  // namespace pointreel
