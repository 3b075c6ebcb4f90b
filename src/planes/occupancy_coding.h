// The hit mask of a range image: one binary decision a cell, from the cells around it that are already known.
#pragma once

#include <algorithm>
#include <vector>

#include "entropy/adaptive_models.h"
#include "planes/range_image.h"

namespace pointreel {

// Codes image.range_m > 0 for every cell; a decoder sets occupied cells to 1 m. `key` is the key frame's
// decoded image for predicted frames, else nullptr; both are bands of the same grid.
template <class Coder>
void code_occupancy(Coder& coder, RangeImage& image, const RangeImage* key) {
  // Context: 4 cells to the left, 5 above, 3 two rows above, and 3 of the key frame around this cell.
  constexpr int kCurrentBits = 12, kKeyBits = 3;
  std::vector<AdaptiveBit> models(std::size_t{1} << (kCurrentBits + (key != nullptr ? kKeyBits : 0)));

  const int columns = image.columns;
  // Rows of bits with three zeros on either side, so that no context looks outside.
  constexpr int kMargin = 3;
  const auto padded = [&] {
    return std::vector<std::uint8_t>(static_cast<std::size_t>(columns + 2 * kMargin), 0);
  };
  std::vector<std::uint8_t> above2 = padded(), above = padded(), current = padded(), in_key = padded();

  for (int row = 0; row < image.rows; ++row) {
    if (key != nullptr) {
      const int key_row = row + image.first_row - key->first_row;
      const bool inside = key_row >= 0 && key_row < key->rows;
      for (int column = 0; column < columns; ++column) {
        in_key[column + kMargin] = inside && key->occupied(key_row, column);
      }
    }
    unsigned west = 0;
    unsigned north = above[kMargin] * 2u + above[kMargin + 1];
    unsigned north2 = above2[kMargin];
    unsigned key_window = in_key[kMargin];
    for (int column = 0; column < columns; ++column) {
      const int i = column + kMargin;
      north = ((north << 1) | above[i + 2]) & 31u;
      north2 = ((north2 << 1) | above2[i + 1]) & 7u;
      key_window = ((key_window << 1) | in_key[i + 1]) & 7u;
      const unsigned context =
          west | (north << 4) | (north2 << 9) | (key != nullptr ? key_window << kCurrentBits : 0u);
      float& range = image.at(row, column);
      const bool hit = coder.code(models[context], range > 0);
      if constexpr (Coder::kDecodes) range = hit ? 1.0f : 0.0f;
      current[i] = hit;
      west = ((west << 1) | (hit ? 1u : 0u)) & 15u;
    }
    std::swap(above2, above);
    std::swap(above, current);
    if constexpr (Coder::kDecodes) {
      if (coder.overran()) return;
    }
  }
}

}  // namespace pointreel
