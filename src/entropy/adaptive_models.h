// Adaptive binary models on top of the range coder, and integers made of binary decisions.
//
// BitEncoder and BitDecoder share one interface, `code(model, bit) -> bit`: the decoder ignores the bit it is
// given and returns the one it reads. Code written once as a template over the coder is its own mirror.
// `code_with(bit, p_one)` does the same for a probability that the caller models.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/range_coder.h"

namespace pointreel {

// P(1) as the mean of a fast and a slow exponential average; both start fast (rate 1/n) and then settle.
class AdaptiveBit {
 public:
  // Within [71, 65465]: an average moves by p >> shift, so the slow one stops at 127, the fast one at 15 from
  // either end. That keeps every coded bit possible, and clear of kMinProbability.
  Probability16 p_one() const { return (static_cast<std::uint32_t>(fast_) + slow_) >> 1; }

  void update(bool bit) {
    const int target = bit ? 65535 : 0;
    fast_ = moved(fast_, target, kFastShifts[count_]);
    slow_ = moved(slow_, target, kSlowShifts[count_]);
    count_ = static_cast<std::uint8_t>(count_ + (count_ < kSettled ? 1 : 0));
  }

 private:
  // Shift of the n-th update: about 1/n until the settled rate is reached.
  static constexpr std::uint8_t kSettled = 6;
  static constexpr std::array<std::uint8_t, kSettled + 1> kFastShifts = {1, 2, 2, 3, 4, 4, 4};
  static constexpr std::array<std::uint8_t, kSettled + 1> kSlowShifts = {1, 2, 2, 3, 4, 5, 7};

  // Rounds towards p, whatever the direction.
  static std::uint16_t moved(std::uint16_t p, int target, int shift) {
    return static_cast<std::uint16_t>(target > p ? p + ((target - p) >> shift) : p - ((p - target) >> shift));
  }

  std::uint16_t fast_ = 32768;
  std::uint16_t slow_ = 32768;
  std::uint8_t count_ = 0;
};
static_assert(71 >= kMinProbability);

class BitEncoder {
 public:
  static constexpr bool kDecodes = false;

  bool code(AdaptiveBit& model, bool bit) {
    coder_.encode(bit, model.p_one());
    model.update(bit);
    return bit;
  }
  bool code_with(bool bit, Probability16 p_one) {
    coder_.encode(bit, p_one);
    return bit;
  }
  bool code_even(bool bit) { return code_with(bit, 32768); }
  // All values below 2^count are equally likely; at most 16 bits.
  std::uint32_t code_bits(std::uint32_t value, int count) {
    coder_.encode_part(value, 1, count);
    return value;
  }
  void code_part(std::uint32_t first, std::uint32_t size, int whole_bits) {
    coder_.encode_part(first, size, whole_bits);
  }
  std::vector<std::uint8_t> finish() { return coder_.finish(); }
  std::size_t size() const { return coder_.size(); }

 private:
  RangeEncoder coder_;
};

class BitDecoder {
 public:
  static constexpr bool kDecodes = true;

  explicit BitDecoder(std::span<const std::uint8_t> bytes) : coder_(bytes) {}
  bool code(AdaptiveBit& model, bool /*ignored*/ = false) {
    const bool bit = coder_.decode(model.p_one());
    model.update(bit);
    return bit;
  }
  bool code_with(bool /*ignored*/, Probability16 p_one) { return coder_.decode(p_one); }
  bool code_even(bool /*ignored*/ = false) { return code_with(false, 32768); }
  std::uint32_t code_bits(std::uint32_t /*ignored*/, int count) {
    const std::uint32_t value = coder_.next_place(count);
    coder_.take_part(value, 1, count);
    return value;
  }
  // A decoder asks first in which part it is.
  std::uint32_t next_place(int whole_bits) const { return coder_.next_place(whole_bits); }
  void code_part(std::uint32_t first, std::uint32_t size, int whole_bits) {
    coder_.take_part(first, size, whole_bits);
  }
  bool overran() const { return coder_.overran(); }

 private:
  RangeDecoder coder_;
};

// A signed integer, small ones likely: zero?, sign, then the magnitude in unary with a model per step, and
// beyond kUnarySteps an Exp-Golomb code of the rest.
class AdaptiveInteger {
 public:
  template <class Coder>
  std::int32_t code(Coder& coder, std::int32_t value) {
    if (!coder.code(nonzero_, value != 0)) return 0;
    const bool negative = coder.code(negative_, value < 0);
    const std::uint32_t magnitude =
        negative ? 0u - static_cast<std::uint32_t>(value) : static_cast<std::uint32_t>(value);
    std::uint32_t coded = 1;
    for (int step = 0; step < kUnarySteps; ++step, ++coded) {
      if (!coder.code(more_[step], magnitude > coded)) return signed_value(coded, negative);
    }
    coded += code_exp_golomb(coder, magnitude - coded);
    return signed_value(coded, negative);
  }

 private:
  static constexpr int kUnarySteps = 12;
  static constexpr int kMaxExponent = 30;  // the value stays within int32 whatever the bytes say

  static std::int32_t signed_value(std::uint32_t magnitude, bool negative) {
    return negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
  }

  template <class Coder>
  std::uint32_t code_exp_golomb(Coder& coder, std::uint32_t value) {
    std::uint32_t exponent = 0;
    while (exponent < kMaxExponent - 1 &&
           coder.code(exponent_[exponent], (static_cast<std::uint64_t>(value) + 1) >> (exponent + 1) != 0)) {
      ++exponent;
    }
    std::uint32_t mantissa = 1;
    for (std::uint32_t bit = exponent; bit-- > 0;) {
      mantissa = (mantissa << 1) | (coder.code_even(((value + 1) >> bit) & 1u) ? 1u : 0u);
    }
    return mantissa - 1;
  }

  AdaptiveBit nonzero_;
  AdaptiveBit negative_;
  std::array<AdaptiveBit, kUnarySteps> more_;
  std::array<AdaptiveBit, kMaxExponent> exponent_;
};

// One byte by a binary tree of models: an adaptive order-0 code, the part Huffman plays in the paper.
class AdaptiveByte {
 public:
  template <class Coder>
  std::uint8_t code(Coder& coder, std::uint8_t value) {
    std::uint32_t node = 1;
    for (int bit = 7; bit >= 0; --bit)
      node = (node << 1) | (coder.code(tree_[node], (value >> bit) & 1) ? 1u : 0u);
    return static_cast<std::uint8_t>(node);
  }

 private:
  std::array<AdaptiveBit, 256> tree_;
};

}  // namespace pointreel
