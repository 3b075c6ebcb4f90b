#include "entropy/range_coder.h"

#include <utility>

namespace pointreel {

void RangeEncoder::put_held_bytes() {
  // It ends at the placeholder at the latest: all that is coded stays below 1.
  if (low_ >> (32 + held_bits_) != 0) {
    for (auto byte = bytes_.rbegin(); ++*byte == 0;) ++byte;
  }
  while (held_bits_ > 0) {
    held_bits_ -= 8;
    bytes_.push_back(static_cast<std::uint8_t>(low_ >> (32 + held_bits_)));
  }
  low_ &= 0xFFFFFFFFu;
}

std::vector<std::uint8_t> RangeEncoder::finish() {
  // Any value in [low, low + range) ends the stream; the one with most trailing zero bits is the shortest.
  const std::uint64_t high = low_ + range_ - 1;
  for (int zero_bits = 32; zero_bits >= 0; --zero_bits) {
    const std::uint64_t candidate = (high >> zero_bits) << zero_bits;
    if (candidate >= low_) {
      low_ = candidate;
      break;
    }
  }
  put_held_bytes();
  for (int bits = 24; bits >= 0; bits -= 8) bytes_.push_back(static_cast<std::uint8_t>(low_ >> bits));
  std::size_t zeros = 0;
  while (zeros < 32 && !bytes_.empty() && bytes_.back() == 0) {
    bytes_.pop_back();
    ++zeros;
  }
  return std::move(bytes_);
}

}  // namespace pointreel
