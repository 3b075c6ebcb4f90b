// Bits that no model helps with.
#pragma once

#include <cstdint>

namespace pointreel {

// The lowest `bits` of value, highest first, each as likely as not.
template <class Coder>
std::uint64_t code_plain_bits(Coder& coder, std::uint64_t value, int bits) {
  std::uint64_t result = 0;
  for (int bit = bits; bit-- > 0;) {
    result = (result << 1) | (coder.code_even((value >> bit) & 1u) ? 1u : 0u);
  }
  return result;
}

}  // namespace pointreel
