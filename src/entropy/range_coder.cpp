#include "entropy/range_coder.h"

namespace pointreel {

void RangeEncoder::shift_low() {
  const bool carry = (low_ >> 32) != 0;
  if (carry || low_ < 0xFF000000u) {
    // The first cache byte is a placeholder, always zero; it is kept so that the decoder starts with five
    // bytes.
    bytes_.push_back(static_cast<std::uint8_t>(cache_ + (carry ? 1 : 0)));
    for (; pending_ > 1; --pending_) bytes_.push_back(static_cast<std::uint8_t>(carry ? 0x00 : 0xFF));
    pending_ = 0;
    cache_ = static_cast<std::uint8_t>(low_ >> 24);
  }
  ++pending_;
  low_ = (low_ & 0x00FFFFFFu) << 8;
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
  for (int i = 0; i < 5; ++i) shift_low();
  std::size_t zeros = 0;
  while (zeros < 32 && !bytes_.empty() && bytes_.back() == 0) {
    bytes_.pop_back();
    ++zeros;
  }
  return std::move(bytes_);
}

}  // namespace pointreel
