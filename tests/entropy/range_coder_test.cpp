#include "entropy/range_coder.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pointreel {
namespace {

constexpr Probability16 kMaxProbability = 65536 - kMinProbability;

struct Decision {
  bool bit;
  Probability16 p_one;
};

std::vector<std::uint8_t> encode(const std::vector<Decision>& decisions) {
  RangeEncoder encoder;
  for (const Decision& decision : decisions) encoder.encode(decision.bit, decision.p_one);
  return encoder.finish();
}

// Number of decisions until the first that comes back wrong.
std::size_t decoded_right(const std::vector<std::uint8_t>& bytes, const std::vector<Decision>& decisions) {
  RangeDecoder decoder(bytes);
  std::size_t right = 0;
  for (const Decision& decision : decisions) {
    if (decoder.decode(decision.p_one) != decision.bit) break;
    ++right;
  }
  EXPECT_FALSE(decoder.overran());
  return right;
}

RC_GTEST_PROP(RangeCoder, BringsBackRandomBitsAtRandomProbabilities, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 3000);
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  // 0: bits as likely as claimed; 1: likely bits only; 2: unlikely bits only.
  const int likelihood = *rc::gen::inRange(0, 3);
  std::uniform_int_distribution<Probability16> probability(kMinProbability, kMaxProbability);
  std::vector<Decision> decisions(count);
  for (Decision& decision : decisions) {
    decision.p_one = probability(random);
    const bool likely = decision.p_one > 32768;
    decision.bit = likelihood == 0 ? random() % 65536 < decision.p_one : (likelihood == 1) == likely;
  }
  RC_ASSERT(decoded_right(encode(decisions), decisions) == count);
}

RC_GTEST_PROP(RangeCoder, BringsBackPartsOfAWholeBetweenBits, ()) {
  struct Part {
    std::uint32_t first, size;
    int whole_bits;
  };
  const auto count = *rc::gen::inRange<std::size_t>(0, 2000);
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  std::vector<Part> parts(count);
  RangeEncoder encoder;
  for (Part& part : parts) {
    part.whole_bits = random() % 3 == 0 ? 16 : static_cast<int>(random() % 16) + 1;
    const std::uint32_t whole = 1U << part.whole_bits;
    // Among them the least there are, which hold back most bytes at once, and those at the upper end.
    const bool least = random() % 3 == 0, last = random() % 3 == 0;
    part.first = last ? whole - 1 : static_cast<std::uint32_t>(random()) % whole;
    part.size = least ? 1 : 1 + static_cast<std::uint32_t>(random()) % (whole - part.first);
    encoder.encode_part(part.first, part.size, part.whole_bits);
    encoder.encode(part.size % 2 == 0, 20'000);
  }
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  for (const Part& part : parts) {
    const std::uint32_t place = decoder.next_place(part.whole_bits);
    RC_ASSERT(place >= part.first && place < part.first + part.size);
    decoder.take_part(part.first, part.size, part.whole_bits);
    RC_ASSERT(decoder.decode(20'000) == (part.size % 2 == 0));
  }
  RC_ASSERT(!decoder.overran());
}

TEST(RangeCoder, WorksAtTheExtremesOfProbability) {
  for (const Probability16 p_one : {kMinProbability, kMaxProbability}) {
    for (const int period : {1, 2, 3, 1000}) {
      std::vector<Decision> decisions;
      for (int i = 0; i < 20'000; ++i) decisions.push_back({i % period == 0, p_one});
      EXPECT_EQ(decoded_right(encode(decisions), decisions), decisions.size()) << p_one << ", " << period;
    }
  }
}

TEST(RangeCoder, SpendsWhatTheProbabilitiesSay) {
  std::mt19937 random(1);
  for (const Probability16 p_one : {kMinProbability, 655u, 6554u, 32768u, 60000u, kMaxProbability}) {
    std::vector<Decision> decisions;
    double bits = 0;
    for (int i = 0; i < 100'000; ++i) {
      const bool bit = random() % 65536 < p_one;
      decisions.push_back({bit, p_one});
      bits -= std::log2((bit ? p_one : 65536 - p_one) / 65536.0);
    }
    const double bytes = static_cast<double>(encode(decisions).size());
    EXPECT_LT(bytes, 1.001 * bits / 8 + 6) << p_one;
    EXPECT_GT(bytes, 0.999 * bits / 8 - 33) << p_one << ": at most 32 trailing zeros are left out";
  }
}

// Decisions that keep the coder's interval astride one fixed number, so that it must hold back a run of 0xFF
// bytes, until the last ones settle on which side the interval comes to lie.
class StraddlingDecisions {
 public:
  explicit StraddlingDecisions(std::uint32_t seed) : random_(seed) {}

  std::vector<Decision> make(int straddling, bool above) {
    for (int i = 0; i < straddling; ++i) {
      auto p_one = static_cast<Probability16>(20'000 + random_() % 25'000);
      if (bound(p_one) == to_border_) ++p_one;
      take({bound(p_one) > to_border_, p_one});
    }
    while (to_border_ > 0 && to_border_ < range_) take({!above, 32768});
    return decisions_;
  }

 private:
  std::int64_t bound(Probability16 p_one) const { return (range_ >> kProbabilityBits) * p_one; }

  void take(Decision decision) {
    const std::int64_t lower = bound(decision.p_one);
    if (!decision.bit) to_border_ -= lower;
    range_ = decision.bit ? lower : range_ - lower;
    for (; range_ < 1 << 24; range_ <<= 8) to_border_ *= 256;
    decisions_.push_back(decision);
  }

  std::mt19937 random_;
  std::vector<Decision> decisions_;
  std::int64_t range_ = 0xFFFFFFFF;
  std::int64_t to_border_ = 0x80000000;  // from the interval's low end
};

TEST(RangeCoder, CarriesThroughRunsOfAnyLength) {
  for (int straddling = 0; straddling < 3000; straddling += 1 + straddling / 7) {
    for (const bool carry : {false, true}) {
      const auto seed = static_cast<std::uint32_t>(straddling);
      const auto decisions = StraddlingDecisions(seed).make(straddling, carry);
      const auto bytes = encode(decisions);
      EXPECT_EQ(decoded_right(bytes, decisions), decisions.size()) << straddling;
      if (straddling < 100) continue;
      // Byte 0 is the coder's placeholder.
      EXPECT_EQ(bytes[1], carry ? 0x80 : 0x7F);
      const std::size_t run = std::min(static_cast<std::size_t>(straddling / 10), bytes.size());
      for (std::size_t i = 2; i < run; ++i) ASSERT_EQ(bytes[i], carry ? 0x00 : 0xFF) << straddling;
    }
  }
}

TEST(RangeCoder, LeavesOutTrailingZerosAndReadsThemBack) {
  std::vector<Decision> decisions(100'000, {true, 32768});  // the lower half each time: every byte is zero
  const auto bytes = encode(decisions);
  EXPECT_EQ(decoded_right(bytes, decisions), decisions.size());
  EXPECT_EQ(encode({}).size(), 0u);
  EXPECT_EQ(encode({{true, 32768}}).size(), 0u);
}

TEST(RangeCoder, ATruncatedStreamOverrunsInTheEnd) {
  std::mt19937 random(7);
  std::vector<Decision> decisions;
  for (int i = 0; i < 20'000; ++i) decisions.push_back({random() % 2 == 0, 32768});
  const auto whole = encode(decisions);
  for (std::size_t kept = 0; kept < whole.size() - 100; kept += 97) {
    // An exact copy, so that the address sanitizer sees a read one byte past it.
    const std::vector<std::uint8_t> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(kept));
    RangeDecoder decoder(cut);
    for (const Decision& decision : decisions) decoder.decode(decision.p_one);
    EXPECT_TRUE(decoder.overran()) << "cut to " << kept << " bytes";
  }
}

TEST(RangeCoder, AnyBytesDecodeToSomething) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::uint8_t> bytes(random() % 64);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(trial % 4 == 0 ? 0xFF : random());
    RangeDecoder decoder(bytes);
    int decisions = 0;
    for (; !decoder.overran() && decisions < 10'000'000; ++decisions) {
      decoder.decode(std::clamp<Probability16>(random() % 65536, kMinProbability, kMaxProbability));
    }
    EXPECT_TRUE(decoder.overran()) << "endless stream from " << bytes.size() << " bytes";
  }
}

}  // namespace
}  // namespace pointreel
