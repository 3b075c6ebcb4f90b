// Predicting a bit from several contexts: in ln(p / (1 - p)), the stretch, what each says is added up, the
// sum is squashed back to a probability, and what was added follows the gradient of the code length. In
// floats: + and * in one fixed order give the same bits everywhere.

#if defined(POINTREEL_PREDICT_BIT_MIXING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_BIT_MIXING_INL_H_
#undef POINTREEL_PREDICT_BIT_MIXING_INL_H_
#else
#define POINTREEL_PREDICT_BIT_MIXING_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/lanes-inl.h"
#include "entropy/bit_mixer.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr float kStretchUnit = 1.F / 256;  // of entropy/bit_mixer.h

inline constexpr auto kStretchTable = [] {
  std::array<float, bit_mixer_detail::kStretch.size()> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(bit_mixer_detail::kStretch[i]) * kStretchUnit;
  return table;
}();
// Within what the coders accept.
inline constexpr auto kSquashTable = [] {
  std::array<std::uint16_t, bit_mixer_detail::kSquash.size()> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::uint32_t p = bit_mixer_detail::kSquash[i];
    table[i] = static_cast<std::uint16_t>(p < kMinProbability           ? kMinProbability
                                          : p > 65536 - kMinProbability ? 65536 - kMinProbability
                                                                        : p);
  }
  return table;
}();

// Without a branch, which a ternary becomes.
POINTREEL_INLINE float clamped(float x, float least, float most) {
  const hn::CappedTag<float, 1> one;
  return hn::GetLane(hn::Max(hn::Min(hn::Set(one, x), hn::Set(one, most)), hn::Set(one, least)));
}

// ln(p / (1 - p)), within +-8.
POINTREEL_INLINE float stretched(float p) {
  constexpr auto kEntries = static_cast<float>(kStretchTable.size());
  return kStretchTable[static_cast<std::uint32_t>(
      static_cast<std::int32_t>(clamped(p * kEntries, 0, kEntries - 1)))];
}
POINTREEL_INLINE float stretched(const CountedBit& bit) {
  return kStretchTable[bit.p_one() >> (kProbabilityBits - bit_mixer_detail::kStretchIndexBits)];
}

POINTREEL_INLINE Probability16 squashed(float stretch) {
  constexpr auto kMost = static_cast<float>(kMaxStretch);
  const float index = clamped(stretch * (1 / kStretchUnit) + (kMost + 0.5F), 0, 2 * kMost);
  return kSquashTable[static_cast<std::uint32_t>(static_cast<std::int32_t>(index))];
}

// By how much a coded bit was underestimated: within +-1.
POINTREEL_INLINE float coding_error(Probability16 p_one, bool bit) {
  return static_cast<float>((bit ? 65536 : 0) - static_cast<std::int32_t>(p_one)) * (1.F / 65536);
}

// Codes a bit by one model alone.
template <class Coder>
POINTREEL_INLINE bool code_counted(Coder& coder, CountedBit& model, bool bit) {
  bit = coder.code_with(bit, std::clamp(model.p_one(), kMinProbability, 65536 - kMinProbability));
  model.update(bit);
  return bit;
}

// Codes a bit whose stretch is `known` plus adaptive terms, each of a context of its own. No weights: how
// much a term says is its size. Terms move by at most `rate` a bit, so that no image of legal size makes them
// overflow. Gives back the rate times the error, too.
template <class Coder, std::size_t kTerms>
POINTREEL_INLINE bool code_sum(Coder& coder, float known, float* const (&terms)[kTerms], float rate, bool bit,
                               float& move) {
  // `known` comes last: it is what has to be waited for.
  float sum = *terms[0];
  for (std::size_t i = 1; i < kTerms; ++i) sum = sum + *terms[i];
  const Probability16 p_one = squashed(sum + known);
  bit = coder.code_with(bit, p_one);
  move = coding_error(p_one, bit) * rate;
  for (float* term : terms) *term = *term + move;
  return bit;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
