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
#include <cstdlib>

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
    lines_ = RowLines(kFastLineRates);
    left_side_ = all_ints<8>(FastRangeState::kSides / 2);
  }

  // Eight cells without returns so far.
  POINTREEL_INLINE void start_step() { coded_.start_step(); }

  // Looks at what is known of them; only needed before code().
  HWY_NOINLINE void predict(int step, const ReferencePlanes* /*none*/) {
    const Neighbourhood cells(coded_.planes, step);
    const Surroundings around(cells, coded_.memory, all<8>(0));
    propose_fast(cells, lines_, around, coded_.proposals);
    Float8 precision[kFastExperts];
    const Blend blend = weigh<kFastExperts>(coded_.errors, cells, coded_.step_m, coded_.proposals, precision);
    squared_error_ = blend.squared_error;
    store(blend.range_m, blend_m_);
    const Int8 error = octaves<FastRangeState::kErrors>(blend.squared_error);
    const Int8 spread = shifted_right<2>(octaves<4 * FastRangeState::kSpreads>(blend.spread));
    const Int8 shift = shifts(error);
    store(error, error_);
    store(shift, shift_);
    steps_per_bin_ = power_of_two(shift);
    const Float8 apart_m =
        (static_cast<float>(BinSymbols::kMostNear) * coded_.step_m) * as_floats(steps_per_bin_);
    alternatives_.find(coded_.memory, around, blend.range_m, apart_m);
    constexpr std::int32_t kKinds = FastRangeState::kKinds, kSpreads = FastRangeState::kSpreads,
                           kSides = FastRangeState::kSides;
    const Int8 kind = load_ints<8>(alternatives_.kind[0]);
    store(((error * all_ints<8>(kSpreads) + spread) * all_ints<8>(kKinds) + kind) * all_ints<8>(kSides) +
              left_side_,
          table_);
    coded_.proposed = true;
  }

  // Those of them that hold a return whose range both sides know; before any is coded.
  POINTREEL_INLINE void take_known(const Float8& range_m, std::uint32_t cells) {
    coded_.take_known(range_m, cells);
  }

  // Codes the ranges of those that hold a return, a bit each, and gives back what a decoder gets, within half
  // a step of `range_m` (which a decoder ignores), beside those that are known; 0 where there is no return.
  template <class Coder>
  POINTREEL_INLINE Float8 code(Coder& coder, std::uint32_t hits, int /*first_row*/, const Float8& range_m) {
    if (hits == 0) return coded_.decoded_m;
    Bins bins;
    if constexpr (!Coder::kDecodes) find_bins(range_m, hits, bins);
    for (std::uint32_t remaining = hits; remaining != 0; remaining = without_first_lane(remaining))
      code_bin(coder, first_lane(remaining), bins);
    const Float8 decoded_m = origin_m(bins.origin) + coded_.step_m * as_floats(bins.steps);
    const Int8 side = select(as_int_mask(decoded_m < load<8>(blend_m_)), all_ints<8>(-kMostContextSteps),
                             all_ints<8>(kMostContextSteps));
    coded_.take(hits, decoded_m, select(bins.origin > all_ints<8>(kBlend), side, bins.steps));
    return coded_.decoded_m;
  }

  // What later cells see of the eight; 0 where there is no return.
  POINTREEL_INLINE const Float8& decoded_m() const { return coded_.decoded_m; }

  // After the last of the eight: remembers them.
  HWY_NOINLINE void remember(int step) {
    constexpr float kLeanBeside = 0.45F, kLeanBeyond = 0.3F;
    coded_.lean_to_prediction(kLeanBeside, kLeanBeyond, squared_error_);
    coded_.remember(step, lines_);
    const Int8 one = all_ints<8>(1);
    left_side_ =
        smaller(larger(coded_.coded_steps + one, all_ints<8>(0)), all_ints<8>(FastRangeState::kSides - 1));
  }

 private:
  static constexpr int kMostShift = 3;
  // Where a bin is counted from: the blend, an alternative, or the blend again where it is far from all.
  enum Origin : std::int32_t {
    kBlend,
    kFirstAlternative,
    kBlendFromAfar = kFirstAlternative + Alternatives::kMost
  };
  static_assert(BinSymbols::kFar - BinSymbols::kAlternative == kBlendFromAfar - kFirstAlternative);

  // Of eight cells: steps from the origin, and for an encoder what to code of them.
  struct Bins {
    Int8 steps = all_ints<8>(0), origin = all_ints<8>(kBlend);
    // Bins of 2^shift steps each, and the step within.
    alignas(32) std::int32_t symbol[Wavefront::kRows], coarse[Wavefront::kRows], fine[Wavefront::kRows];

    POINTREEL_INLINE Bins() {}
  };

  POINTREEL_INLINE Float8 origin_m(const Int8& origin) const {
    Float8 origin_m = coded_.quantised(load<8>(blend_m_));
    for (std::size_t i = 0; i < Alternatives::kMost; ++i) {
      const auto its_number = all_ints<8>(kFirstAlternative + static_cast<std::int32_t>(i));
      origin_m = select(as_float_mask(origin == its_number),
                        coded_.quantised(load<8>(alternatives_.range_m[i])), origin_m);
    }
    return origin_m;
  }

  // Near what the ranges of `hits` are, a bit each, and in which bins from there.
  POINTREEL_INLINE void find_bins(const Float8& range_m, std::uint32_t hits, Bins& bins) const {
    const Int8 shift = load_ints<8>(shift_), half = shifted_right<1>(steps_per_bin_);
    const auto steps_from = [&](const Float8& origin_m) HWY_ATTR {
      return rounded(per_step_ * (range_m - coded_.quantised(origin_m)));
    };
    const auto is_far = [&](const Int8& steps) HWY_ATTR {
      return absolute((steps + half) >> shift) > all_ints<8>(BinSymbols::kMostNear);
    };
    bins.steps = steps_from(load<8>(blend_m_));
    const IntMask<8> far = is_far(bins.steps);
    if ((lane_bits(as_float_mask(far)) & hits) != 0) {
      bins.origin = where(far, all_ints<8>(kBlendFromAfar));
      for (std::size_t i = Alternatives::kMost; i-- > 0;) {
        const Int8 steps = steps_from(load<8>(alternatives_.range_m[i]));
        const Int8 none = all_ints<8>(Alternatives::kNone);
        const Int8 kind = select(is_far(steps), none, load_ints<8>(alternatives_.kind[i]));
        const IntMask<8> near = where(far, kind) > none;
        bins.steps = select(near, steps, bins.steps);
        bins.origin =
            select(near, all_ints<8>(kFirstAlternative + static_cast<std::int32_t>(i)), bins.origin);
      }
    }
    const Int8 steps = bins.steps + half, coarse = steps >> shift;
    store(coarse, bins.coarse);
    store(steps & (steps_per_bin_ - all_ints<8>(1)), bins.fine);
    const Int8 beyond_blend = bins.origin + all_ints<8>(BinSymbols::kAlternative - kFirstAlternative);
    store(select(bins.origin > all_ints<8>(kBlend), beyond_blend, near_symbols(coarse)), bins.symbol);
  }
  // As BinSymbols::symbol_of().
  static POINTREEL_INLINE Int8 near_symbols(const Int8& coarse) {
    const Int8 one = all_ints<8>(1), zero = all_ints<8>(BinSymbols::kZero), magnitude = absolute(coarse);
    Int8 size = all_ints<8>(0);
    for (std::size_t i = 1; i <= BinSymbols::kZero; ++i) {
      const std::int32_t nearest = kBinSymbols.group[BinSymbols::kZero + i].nearest;
      size = size + where(magnitude > all_ints<8>(nearest - 1), one);
    }
    return select(coarse > all_ints<8>(0), zero + size, zero - size);
  }

  // Codes that of one cell; a decoder puts it in its lane.
  template <class Coder>
  POINTREEL_INLINE void code_bin(Coder& coder, std::size_t cell, Bins& bins) {
    std::size_t symbol = 0;
    std::int32_t coarse = 0;
    std::uint32_t fine = 0;
    if constexpr (!Coder::kDecodes) {
      symbol = static_cast<std::size_t>(bins.symbol[cell]);
      coarse = bins.coarse[cell];
      fine = static_cast<std::uint32_t>(bins.fine[cell]);
    }
    symbol = code_symbol(coder, state_.of_cell[static_cast<std::size_t>(table_[cell])], symbol);
    if (symbol < BinSymbols::kAlternative) {
      coarse = code_rest(coder, symbol, coarse);
    } else if (symbol < BinSymbols::kFar) {
      coarse = code_near_alternative(coder, cell, symbol - BinSymbols::kAlternative, coarse);
    } else {
      coarse = code_far(coder, static_cast<std::size_t>(error_[cell]), coarse);
    }
    const std::int32_t shift = shift_[cell];
    if (shift > 0) fine = coder.code_bits(fine, shift);
    if constexpr (Coder::kDecodes) {
      const IntMask<8> lane = only_lane(cell);
      const std::int32_t half = (1 << shift) >> 1;
      bins.steps = select(lane, all_ints<8>(coarse * (1 << shift) + static_cast<std::int32_t>(fine) - half),
                          bins.steps);
      if (symbol >= BinSymbols::kAlternative) {
        const auto origin = static_cast<std::int32_t>(symbol - BinSymbols::kAlternative) + kFirstAlternative;
        bins.origin = select(lane, all_ints<8>(origin), bins.origin);
      }
    }
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
    symbol = code_symbol(coder, state_.of_alternative[table], symbol);
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
  // An encoder never gets there: a blend is at most 1.5 times a range.
  static constexpr std::uint32_t kMostBeyond = 1U << 26;
  static_assert(kMostBeyond > 3 * static_cast<std::uint32_t>(kMostRangeSteps));

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
  RowLines lines_ = RowLines(kFastLineRates);
  Int8 left_side_;  // of the prediction, on which the range left of each cell was
  FastRangeState& state_;

  // Of the eight cells at hand.
  Alternatives alternatives_;
  alignas(32) float blend_m_[Wavefront::kRows];
  Float8 squared_error_;  // of the blend, in squared steps
  Int8 steps_per_bin_;
  alignas(32) std::int32_t error_[Wavefront::kRows], shift_[Wavefront::kRows];
  alignas(32) std::int32_t table_[Wavefront::kRows];
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
