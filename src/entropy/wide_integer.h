// Unsigned integers of up to 64 bits with adaptive models: nought, then the length in bits, then the
// mantissa, its first bits modelled. Learns small alphabets of large numbers as well as geometric sources.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_models.h"

namespace pointreel {

class AdaptiveWideInteger {
 public:
  // Bits below the leading one, counted from it, that are modelled given all before them: of short numbers
  // all, of longer ones the first few.
  explicit AdaptiveWideInteger(int modelled_bits = 10)
      : modelled_bits_(modelled_bits), mantissa_(std::size_t{64} << modelled_bits) {}

  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t value) {
    if (!coder.code(nonzero_, value != 0)) return 0;
    std::uint32_t node = 1;  // length - 1, of 6 bits
    const auto wanted = static_cast<std::uint32_t>(std::bit_width(value) - 1);
    for (int bit = 5; bit >= 0; --bit) {
      node = (node << 1) | (coder.code(length_[node], (wanted >> bit) & 1u) ? 1u : 0u);
    }
    const std::uint32_t below = node - 64;  // bits below the leading one
    std::uint64_t result = 1;
    AdaptiveBit* const tree = mantissa_.data() + (static_cast<std::size_t>(below) << modelled_bits_);
    for (std::uint32_t bit = below; bit-- > 0;) {
      const bool wanted_bit = (value >> bit) & 1u;
      const bool modelled = below - bit <= static_cast<std::uint32_t>(modelled_bits_);
      result = (result << 1) |
               ((modelled ? coder.code(tree[result], wanted_bit) : coder.code_even(wanted_bit)) ? 1u : 0u);
    }
    return result;
  }

 private:
  int modelled_bits_;
  AdaptiveBit nonzero_;
  std::array<AdaptiveBit, 64> length_;
  std::vector<AdaptiveBit> mantissa_;  // [length - 1][prefix with its leading one]
};

// Signed as unsigned, small magnitudes first: 0, -1, 1, -2, ...
inline std::uint64_t zigzag(std::uint64_t twos_complement) {
  return (twos_complement << 1) ^ (0 - (twos_complement >> 63));
}
inline std::uint64_t unzigzag(std::uint64_t value) {
  return (value >> 1) ^ (0 - (value & 1));
}

}  // namespace pointreel
