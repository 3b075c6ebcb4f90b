// The hit mask of a range image: one binary decision a cell, from the cells around it that are already known.
#pragma once

#include <utility>
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
  AdaptiveBit* const model = models.data();

  // Rows of bits with zeros on either side, so that no context looks outside. Not bytes: a store to a byte
  // may alias anything, and the coder's state would leave its registers.
  constexpr int kMargin = 2;
  using BitRow = std::vector<std::uint16_t>;
  const BitRow no_hits(static_cast<std::size_t>(image.columns + 2 * kMargin), 0);
  BitRow two_above = no_hits, one_above = no_hits, this_row = no_hits, key_row = no_hits, known = no_hits;

  for (int row = 0; row < image.rows; ++row) {
    if (key != nullptr) {
      const int row_in_key = row + image.first_row - key->first_row;
      const bool inside = row_in_key >= 0 && row_in_key < key->rows;
      for (int column = 0; column < image.columns; ++column) {
        key_row[column + kMargin] = inside && key->occupied(row_in_key, column);
      }
    }
    // The part of the contexts that is known before the row: a SIMD loop.
    const std::uint16_t* n = one_above.data() + kMargin;
    const std::uint16_t* nn = two_above.data() + kMargin;
    const std::uint16_t* k = key_row.data() + kMargin;  // stays 0 without a key frame
    for (int c = 0; c < image.columns; ++c) {
      known[c] =
          static_cast<std::uint16_t>((n[c - 2] << 4) | (n[c - 1] << 5) | (n[c] << 6) | (n[c + 1] << 7) |
                                     (n[c + 2] << 8) | (nn[c - 1] << 9) | (nn[c] << 10) | (nn[c + 1] << 11) |
                                     (k[c - 1] << 12) | (k[c] << 13) | (k[c + 1] << 14));
    }
    const std::uint16_t* known_here = known.data();
    std::uint16_t* current = this_row.data() + kMargin;
    float* ranges = image.range_m.data() + image.index(row, 0);
    unsigned left = 0;
    for (int column = 0; column < image.columns; ++column) {
      const bool hit = coder.code(model[known_here[column] | left], ranges[column] > 0);
      if constexpr (Coder::kDecodes) ranges[column] = hit ? 1.0f : 0.0f;
      current[column] = hit;
      left = ((left << 1) | (hit ? 1u : 0u)) & 15u;
    }
    std::swap(two_above, one_above);
    std::swap(one_above, this_row);
    if constexpr (Coder::kDecodes) {
      if (coder.overran()) return;
    }
  }
}

}  // namespace pointreel
