#include "predict/priors.h"

#include <array>
#include <cstdint>

namespace pointreel {
namespace {

// 2^(eighths / 8) for all eighths of eight bits, exact to a rounding: + - * / only.
constexpr auto kPowersOfTwo = [] {
  constexpr double kFractions[8] = {1,
                                    1.0905077326652577,
                                    1.1892071150027210,
                                    1.2968395546510096,
                                    1.4142135623730951,
                                    1.5422108254079407,
                                    1.6817928305074290,
                                    1.8340080864093424};
  static_assert(kPriorsPerOctave == 8);
  std::array<float, 256> powers{};
  for (int eighths = -128; eighths < 128; ++eighths) {
    double power = kFractions[eighths & 7];
    for (int octaves = eighths >> 3; octaves > 0; --octaves) power *= 2;
    for (int octaves = eighths >> 3; octaves < 0; ++octaves) power /= 2;
    powers[static_cast<std::size_t>(eighths + 128)] = static_cast<float>(power);
  }
  return powers;
}();

float power_of_two(std::int8_t eighths) {
  return kPowersOfTwo[static_cast<std::size_t>(eighths + 128)];
}

// Reads a table.
class PriorReader {
 public:
  explicit PriorReader(std::span<const std::int8_t> table) : next_(table.data()) {}

  void logarithm(float& value) { value = power_of_two(*next_++); }
  void weight(float& value) { value = static_cast<float>(*next_++) / kPriorsPerWeight; }
  void bit(CountedBit& bit) {
    const auto prior = static_cast<std::uint8_t>(*next_++);
    bit = {squash((prior >> 2) * kPriorStep - kMaxStretch + kPriorStep / 2 - 1), kPriorCounts[prior & 3]};
  }
  template <std::size_t kTables>
  void symbols(SymbolTables<kTables>& tables) {
    for (SymbolTable& table : tables) {
      table.cumulative[kSymbols - 1] = kLearntAfter[static_cast<std::uint8_t>(*next_++)];
      std::array<float, kSymbols> weight{};
      float total = 0;
      for (float& w : weight) total += w = power_of_two(*next_++);
      float sum = 0;
      for (std::size_t i = 0; i + 1 < kSymbols; ++i) {
        sum += weight[i];
        table.cumulative[i] = static_cast<std::uint16_t>(sum / total * 65535);
      }
    }
  }
  // Rows share their priors, so that those do not know one sensor's rows.
  void bits_by_row(CountedBit* bits, std::size_t rows, std::size_t per_row) {
    for (std::size_t i = 0; i < per_row; ++i) bit(bits[i]);
    for (std::size_t i = per_row; i < rows * per_row; ++i) bits[i] = bits[i - per_row];
  }

  void weights_by_row(float* weights, std::size_t rows, std::size_t per_row) {
    for (std::size_t i = 0; i < per_row; ++i) weight(weights[i]);
    for (std::size_t i = per_row; i < rows * per_row; ++i) weights[i] = weights[i - per_row];
  }

 private:
  const std::int8_t* next_;
};

}  // namespace

BandState state_from_priors(const CodingKind& kind, float step_m, const Band& band) {
  BandState state{HitMaskState(static_cast<std::size_t>(band.rows)), {}, {}, {}};
  PriorReader mask(hit_mask_priors(kind));
  visit_hit_mask_state(state.mask, mask);
  PriorReader ranges(range_priors(kind, prior_set(step_m)));
  if (kind.effort == Effort::fast) {
    visit_fast_range_state(state.fast, ranges);
    return state;
  }
  if (has_trust(kind)) {
    state.trust.make();
    visit_max_range_state(state.trust, ranges);
    return state;
  }
  visit_range_state(state.ranges, kind, ranges);
  return state;
}

}  // namespace pointreel
