// Codes which bin of the quantiser a range falls into without a mixture: adaptive models alone answer the questions.
// Effort `fast`.

#if defined(POINTREEL_PREDICT_DIRECT_CODER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_DIRECT_CODER_INL_H_
#undef POINTREEL_PREDICT_DIRECT_CODER_INL_H_
#else
#define POINTREEL_PREDICT_DIRECT_CODER_INL_H_
#endif

#include <algorithm>
#include <cstdint>

#include "predict/step_context-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <class Coder>
POINTREEL_INLINE bool code_directly(Coder& coder, CountedBit& model, bool bit) {
  constexpr std::uint32_t kSettledCount = 100;
  bit = coder.code_with(bit, std::clamp(model.p_one(), kMinProbability, 65536 - kMinProbability));
  model.update<kSettledCount>(bit);
  return bit;
}

// Codes `wanted` (ignored when decoding) and returns it.
template <class Coder>
POINTREEL_INLINE std::int32_t code_directly(Coder& coder, DirectModels& models, const StepContext& at,
                                            std::int32_t wanted) {
  constexpr auto kUnarySteps = static_cast<std::int32_t>(DirectModels::kUnarySteps);
  const std::size_t place = at.error * DirectModels::kSpreads + at.spread;
  if (code_directly(coder, models.zero[place * StepModels::kActivities + at.activity], wanted == 0)) return 0;
  const bool down = code_directly(coder, models.sign[at.signs], wanted < 0);
  const std::int32_t size = down ? -wanted : wanted;
  std::int32_t magnitude = 1;
  for (; magnitude <= kUnarySteps; ++magnitude) {
    const std::size_t step = place * DirectModels::kUnarySteps + static_cast<std::size_t>(magnitude - 1);
    if (!code_directly(coder, models.more[step], size > magnitude)) return down ? -magnitude : magnitude;
  }
  // magnitude + rest: the number of the rest's bits, then those.
  const auto rest = static_cast<std::uint32_t>(size - magnitude + 1);
  std::uint32_t bits = 1;
  while (bits < DirectModels::kMostBits && code_directly(coder, models.longer[bits], rest >> bits != 0)) ++bits;
  std::uint32_t value = 1;
  for (std::uint32_t bit = bits - 1; bit-- > 0;)
    value = value << 1 | (coder.code_with((rest >> bit & 1) != 0, 32768) ? 1U : 0U);
  magnitude += static_cast<std::int32_t>(value) - 1;
  return down ? -magnitude : magnitude;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
