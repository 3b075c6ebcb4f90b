#include "predict/range_state.h"

#include <span>

#include "predict/hit_mask_priors.h"
#include "predict/range_priors.h"

namespace pointreel {
namespace {

// 2^(eighths / 8), exact to a rounding: + - * / only.
float power_of_two(int eighths) {
  constexpr double kFractions[8] = {1,
                                    1.0905077326652577,
                                    1.1892071150027210,
                                    1.2968395546510096,
                                    1.4142135623730951,
                                    1.5422108254079407,
                                    1.6817928305074290,
                                    1.8340080864093424};
  double result = kFractions[eighths & 7];
  for (int octaves = eighths >> 3; octaves > 0; --octaves) result *= 2;
  for (int octaves = eighths >> 3; octaves < 0; ++octaves) result /= 2;
  return static_cast<float>(result);
}

template <std::size_t kInputs, std::size_t kSets>
void set_weights(std::array<BitMixer<kInputs>, kSets>& mixers, std::span<const std::int16_t> weights) {
  for (std::size_t set = 0; set < kSets; ++set) {
    for (std::size_t input = 0; input < kInputs; ++input) {
      mixers[set].set_weight(static_cast<int>(input),
                             weights[set * kInputs + input] * (BitMixer<kInputs>::kOne / 256));
    }
  }
}

template <std::size_t kBits, std::size_t kPriors>
void set_bits(std::array<CountedBit, kBits>& bits, const std::array<std::uint8_t, kPriors>& priors) {
  for (std::size_t i = 0; i < kBits; ++i) bits[i] = bit_from_prior(priors[i % kPriors]);
}

}  // namespace

RangeModelState RangeModelState::from_priors(float step_m) {
  const RangePriors& priors = kRangePriors[prior_set(step_m)];
  RangeModelState state;
  for (std::size_t i = 0; i < kErrorClasses; ++i) {
    for (std::size_t k = 0; k < kExperts; ++k) {
      state.mixture.classes[i].weight[k] = power_of_two(priors.weight[i * kExperts + k]);
      state.mixture.classes[i].inverse_scale[k] = power_of_two(priors.inverse_scale[i * kExperts + k]);
    }
  }
  set_bits(state.steps.zero_by_activity, priors.zero_by_activity);
  set_bits(state.steps.zero_by_row, priors.zero_by_row);
  set_bits(state.steps.sign_by_signs, priors.sign_by_signs);
  set_bits(state.steps.sign_by_row, priors.sign_by_row);
  set_bits(state.steps.more_by_error, priors.more_by_error);
  set_weights(state.steps.zero_mixers, priors.zero_mixers);
  set_weights(state.steps.sign_mixers, priors.sign_mixers);
  set_weights(state.steps.more_mixers, priors.more_mixers);
  return state;
}

}  // namespace pointreel
