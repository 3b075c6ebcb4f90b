// Predicts and codes the ranges of one band of rows for effort fast: no mixture, one symbol a cell.
//
//   propose -> blend by recent errors -> code the bin as a symbol -> reconstruct        (eight cells at a
//   time)
//
// At depth edges the blend is often wrong by far, but some cell around shows the surface: alternatives stand
// for those, and symbols say which of them is right.

#if defined(POINTREEL_PREDICT_FAST_RANGE_MODEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_FAST_RANGE_MODEL_INL_H_
#undef POINTREEL_PREDICT_FAST_RANGE_MODEL_INL_H_
#else
#define POINTREEL_PREDICT_FAST_RANGE_MODEL_INL_H_
#endif

#include <algorithm>
#include <bit>

#include "predict/alternatives-inl.h"
#include "predict/band_coding.h"
#include "predict/bin_symbols.h"
#include "predict/bit_mixing-inl.h"
#include "predict/coded_ranges-inl.h"
#include "predict/fast_experts-inl.h"
#include "predict/fast_range_state.h"
#include "predict/range_rounding-inl.h"
#include "predict/step_context-inl.h"
#include "predict/symbol_coding-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

class FastRangeModel {
 public:
  FastRangeModel(int columns, const BandSetting& setting, BandState& state)
      : coded_(columns, setting.quantiser), per_step_(1 / coded_.step_m), state_(state.fast) {
    // Bins of small steps are coded in twos, fours or eights where errors are large.
    constexpr float kWideM = 0.02F;
    for (float wide_m = 2 * coded_.step_m; wide_m <= kWideM && most_shift_ < kMostShift; wide_m = 2 * wide_m)
      ++most_shift_;
  }

  void start_block(const std::array<float, Wavefront::kRows>& lattice_phase_m) {
    coded_.start_block(lattice_phase_m);
    lines_ = RowLines();
  }

  // Eight cells without returns so far.
  POINTREEL_INLINE void start_step() { coded_.start_step(); }

  // Looks at what is known of them; only needed before code().
  HWY_NOINLINE void predict(int step, const ReferencePlanes* /*none*/) {
    const Neighbourhood cells(coded_.planes, step);
    const Surroundings around(cells, coded_.memory, all<8>(0));
    propose_fast(cells, coded_.memory, lines_, around, coded_.proposals);
    Float8 precision[kFastExperts];
    const Blend blend = weigh<kFastExperts>(coded_.errors, coded_.row_errors, cells, step, coded_.step_m,
                                            coded_.proposals, precision);
    squared_error_ = blend.squared_error;
    store(blend.range_m, blend_m_);
    const Int8 error = octaves<FastRangeState::kErrors>(blend.squared_error);
    const Int8 spread = shifted_right<2>(octaves<4 * FastRangeState::kSpreads>(blend.spread));
    const Int8 shift = shifts(error);
    store(error, error_);
    store(shift, shift_);
    const Float8 apart_m =
        (static_cast<float>(BinSymbols::kMostNear) * coded_.step_m) * as_floats(power_of_two(shift));
    alternatives_.find(cells, coded_.memory, around, blend.range_m, apart_m);
    constexpr std::int32_t kKinds = FastRangeState::kKinds, kSpreads = FastRangeState::kSpreads;
    store(
        (error * all_ints<8>(kSpreads) + spread) * all_ints<8>(kKinds) + load_ints<8>(alternatives_.kind[0]),
        by_error_);
    store(StepContexts::signs(coded_.steps, step), by_signs_);
    coded_.proposed = true;
  }

  // Those of them that hold a return whose range both sides know; before any is coded.
  POINTREEL_INLINE void take_known(const Float8& range_m, std::uint32_t cells) {
    coded_.take_known(range_m, cells);
  }

  // (Nothing of one cell waits for another.)
  POINTREEL_INLINE void start(std::size_t /*cell*/, int /*row*/) {}
  POINTREEL_INLINE void learn(std::size_t /*cell*/) {}

  // Codes the range of one that holds a return and gives back the reconstruction, within half a step of
  // `range_m` (which a decoder ignores).
  template <class Coder>
  POINTREEL_INLINE float code(Coder& coder, std::size_t cell, int /*row*/, float range_m) {
    const std::int32_t shift = shift_[cell];
    Bin bin{};
    std::size_t symbol = 0;
    if constexpr (!Coder::kDecodes) symbol = find_bin(cell, range_m, bin);
    symbol = code_symbol(coder, state_.by_error, static_cast<std::size_t>(by_error_[cell]), state_.by_signs,
                         static_cast<std::size_t>(by_signs_[cell]), symbol);
    float origin_m = coded_.quantised(blend_m_[cell], cell);
    if (symbol < BinSymbols::kAlternative) {
      bin.coarse = code_rest(coder, symbol, bin.coarse);
    } else if (symbol < BinSymbols::kFar) {
      origin_m = coded_.quantised(alternatives_.range_m[symbol - BinSymbols::kAlternative][cell], cell);
      bin.coarse = code_near_alternative(coder, cell, symbol - BinSymbols::kAlternative, bin.coarse);
    } else {
      bin.coarse = code_far(coder, static_cast<std::size_t>(error_[cell]), bin.coarse);
    }
    if (shift > 0) bin.fine = coder.code_bits(bin.fine, shift);
    const std::int32_t steps = bin.coarse * (1 << shift) + static_cast<std::int32_t>(bin.fine) - half(shift);
    const float decoded_m = origin_m + static_cast<float>(steps) * coded_.step_m;
    const std::int32_t from_blend = symbol < BinSymbols::kAlternative ? steps
                                    : decoded_m < blend_m_[cell]      ? -kMostContextSteps
                                                                      : kMostContextSteps;
    return coded_.take(cell, decoded_m, from_blend);
  }

  // What later cells see of the eight; 0 where there is no return.
  POINTREEL_INLINE const Float8& decoded_m() const { return coded_.decoded_m; }

  // After the last of the eight: remembers them.
  HWY_NOINLINE void remember(int step) {
    constexpr float kLeanBeside = 0.45F, kLeanBeyond = 0.3F;
    coded_.lean_to_prediction(kLeanBeside, kLeanBeyond, squared_error_);
    coded_.remember(step, lines_);
  }

 private:
  static constexpr int kMostShift = 3;

  // Steps from an origin: coarse of 2^shift each, and the step within.
  struct Bin {
    std::int32_t coarse;
    std::uint32_t fine;
  };
  static std::int32_t half(std::int32_t shift) { return (1 << shift) >> 1; }

  Bin bin_from(std::size_t cell, float origin_m, float range_m) const {
    const std::int32_t shift = shift_[cell];
    const std::int32_t steps =
        rounded((range_m - coded_.quantised(origin_m, cell)) * per_step_) + half(shift);
    return {steps >> shift, static_cast<std::uint32_t>(steps & ((1 << shift) - 1))};
  }
  static bool is_near(const Bin& bin) { return std::abs(bin.coarse) <= BinSymbols::kMostNear; }

  // Near what the range is, and in which bin from there.
  POINTREEL_INLINE std::size_t find_bin(std::size_t cell, float range_m, Bin& bin) const {
    bin = bin_from(cell, blend_m_[cell], range_m);
    if (is_near(bin)) return kBinSymbols.symbol_of(bin.coarse);
    for (std::size_t i = 0; i < Alternatives::kMost && alternatives_.kind[i][cell] != Alternatives::kNone;
         ++i) {
      const Bin from_alternative = bin_from(cell, alternatives_.range_m[i][cell], range_m);
      if (!is_near(from_alternative)) continue;
      bin = from_alternative;
      return BinSymbols::kAlternative + i;
    }
    return BinSymbols::kFar;
  }

  template <class Coder>
  static POINTREEL_INLINE std::int32_t code_rest(Coder& coder, std::size_t symbol, std::int32_t coarse) {
    const BinSymbols::Group& group = kBinSymbols.group[symbol];
    if (group.bits == 0) return group.nearest;
    const auto beyond = static_cast<std::int32_t>(
        coder.code_bits(static_cast<std::uint32_t>(std::abs(coarse - group.nearest)), group.bits));
    return group.nearest + (group.nearest < 0 ? -beyond : beyond);
  }

  template <class Coder>
  HWY_NOINLINE std::int32_t code_near_alternative(Coder& coder, std::size_t cell, std::size_t alternative,
                                                  std::int32_t coarse) {
    const bool farther = alternatives_.range_m[alternative][cell] > blend_m_[cell];
    const std::size_t table =
        static_cast<std::size_t>(alternatives_.kind[alternative][cell]) * 2 + (farther ? 1 : 0);
    std::size_t symbol = Coder::kDecodes ? 0 : kBinSymbols.symbol_of(coarse);
    symbol = code_symbol(coder, state_.of_alternative, table, symbol);
    return code_rest(coder, std::min(symbol, BinSymbols::kAlternative - 1), coarse);
  }

  // Sign and Exp-Golomb code of what is beyond kMostNear, the last two bits evenly.
  template <class Coder>
  HWY_NOINLINE std::int32_t code_far(Coder& coder, std::size_t error, std::int32_t coarse) {
    constexpr std::int32_t kLeast = BinSymbols::kMostNear + 1;
    const bool below = code_counted(coder, state_.far_sign[error], coarse < 0);
    const auto beyond = static_cast<std::uint32_t>(std::max(0, std::abs(coarse) - kLeast));
    const std::uint32_t quarter = (beyond >> 2) + 1;
    int exponent = 0;
    while (exponent + 1 < static_cast<int>(FastRangeState::kExponents) &&
           code_counted(coder, state_.far_exponent[static_cast<std::size_t>(exponent)],
                        quarter >> (exponent + 1) != 0))
      ++exponent;
    std::uint32_t value = 1;
    for (int bit = exponent - 1; bit >= 0; --bit)
      value = value << 1 | coder.code_bits(quarter >> bit & 1U, 1);
    value = (value - 1) << 2 | coder.code_bits(beyond & 3U, 2);
    // Exponents up to 27 keep this within 30 bits, and with the shift within what fits.
    const std::int32_t magnitude = kLeast + static_cast<std::int32_t>(std::min(value, kMostBeyond));
    return below ? -magnitude : magnitude;
  }
  static constexpr std::uint32_t kMostBeyond = 1U << 26;

  // Octaves of squared steps from 2^-6 on, clamped to kCount.
  template <std::size_t kCount>
  static POINTREEL_INLINE Int8 octaves(const Float8& squared_steps) {
    constexpr float kFloor = 0.0016F;
    const Int8 octave = shifted_right<23>(bits_of(squared_steps + all<8>(kFloor))) - all_ints<8>(127 - 6);
    return larger(smaller(octave, all_ints<8>(static_cast<std::int32_t>(kCount) - 1)), all_ints<8>(0));
  }
  // From errors of 2^7 squared steps on, as far as steps are small: half their logarithm.
  POINTREEL_INLINE Int8 shifts(const Int8& error) const {
    const Int8 wide = shifted_right<1>(error - all_ints<8>(11));
    return larger(smaller(wide, all_ints<8>(most_shift_)), all_ints<8>(0));
  }
  static POINTREEL_INLINE Int8 power_of_two(const Int8& shift) {
    const Int8 one = all_ints<8>(1);
    Int8 power = one;
    for (int i = 0; i < kMostShift; ++i) power = power + where(shift > all_ints<8>(i), power);
    return power;
  }

  CodedRanges<kFastExperts> coded_;
  float per_step_;
  std::int32_t most_shift_ = 0;
  RowLines lines_;
  FastRangeState& state_;

  // Of the eight cells at hand.
  Alternatives alternatives_;
  alignas(32) float blend_m_[Wavefront::kRows];
  Float8 squared_error_;  // of the blend, in squared steps
  alignas(32) std::int32_t error_[Wavefront::kRows], shift_[Wavefront::kRows];
  alignas(32) std::int32_t by_error_[Wavefront::kRows], by_signs_[Wavefront::kRows];
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
