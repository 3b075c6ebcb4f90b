// Binary range coder: turns (bit, probability) pairs into bytes and back, exactly, on every machine.
//
// Carry-propagating coder with 32-bit range (Martin 1979); the bytes are those of the form that Pavlov's LZMA
// made common. Probabilities are 16-bit integers, so nothing here depends on floating point. Symbols of more
// than two values are parts of a whole of 2^n, n up to 16.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pointreel {

// P(bit = 1) in units of 1/65536; coders accept [kMinProbability, 65536 - kMinProbability].
using Probability16 = std::uint32_t;
inline constexpr int kProbabilityBits = 16;
inline constexpr Probability16 kMinProbability = 32;

class RangeEncoder {
 public:
  void encode(bool bit, Probability16 p_one) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * p_one;
    // Without a branch: bits worth coding are hard to predict.
    const std::uint32_t if_zero = bit ? 0u : ~0u;
    low_ += bound & if_zero;
    range_ = bound + ((range_ - 2 * bound) & if_zero);
    renormalise();
  }

  // The part [first, first + size) of 2^whole_bits.
  void encode_part(std::uint32_t first, std::uint32_t size, int whole_bits) {
    const std::uint32_t unit = range_ >> whole_bits;
    low_ += std::uint64_t{unit} * first;
    range_ = unit * size;
    renormalise();
  }

  // Ends the stream; the encoder is spent afterwards. Trailing zero bytes are left out: the decoder reads
  // zeros past the end.
  std::vector<std::uint8_t> finish();

  // Bytes so far, for statistics by part (right to within the coder's five bytes of look-ahead).
  std::size_t size() const { return bytes_.size() + static_cast<std::size_t>(held_bits_ / 8); }

 private:
  // Whole bytes leave the interval as soon as its range is below 2^24. Without a loop: how many there are is
  // as hard to predict as the bits. Two at most, as a part is at least 2^-16 of the range.
  // (That is never 0; the 1 saves processors without lzcnt a branch for it.)
  void renormalise() {
    const int shift = std::countl_zero(range_ | 1) & 24;
    range_ <<= shift;
    low_ <<= shift;
    held_bits_ += shift;
    if (held_bits_ >= kMostHeldBits) put_held_bytes();
  }
  void put_held_bytes();

  static constexpr int kMostHeldBits = 16;

  // The first byte is a placeholder, always zero, with which the decoder starts.
  std::vector<std::uint8_t> bytes_{0};
  std::uint64_t low_ = 0;  // 32 bits, those held back until there are enough of them, and above a carry
  int held_bits_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
};

class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    for (int i = 0; i < 5; ++i) code_ = (code_ << 8) | next_byte();
  }

  bool decode(Probability16 p_one) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * p_one;
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    renormalise();
    return bit;
  }

  // A place in the part that comes next; take_part() then takes that part.
  std::uint32_t next_place(int whole_bits) const {
    return std::min(code_ / (range_ >> whole_bits), (std::uint32_t{1} << whole_bits) - 1);
  }
  void take_part(std::uint32_t first, std::uint32_t size, int whole_bits) {
    const std::uint32_t unit = range_ >> whole_bits;
    code_ -= unit * first;
    range_ = unit * size;
    renormalise();
  }

  // True when more bytes were asked for than any encoder's stream of this length can need: the input is
  // damaged.
  bool overran() const { return position_ > bytes_.size() + kSlack; }

 private:
  static constexpr std::uint32_t kTop = 1u << 24;
  static constexpr std::size_t kSlack = 64;  // dropped trailing zeros; longer runs are put back by finish()

  void renormalise() {
    while (range_ < kTop) {
      range_ <<= 8;
      code_ = (code_ << 8) | next_byte();
    }
  }
  std::uint32_t next_byte() {
    const std::size_t i = position_++;
    return i < bytes_.size() ? bytes_[i] : 0u;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint32_t code_ = 0;
};

}  // namespace pointreel
