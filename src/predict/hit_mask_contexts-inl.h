// The contexts in which the bits of the hit mask are seen, eight cells at once.

#if defined(POINTREEL_PREDICT_HIT_MASK_CONTEXTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_HIT_MASK_CONTEXTS_INL_H_
#undef POINTREEL_PREDICT_HIT_MASK_CONTEXTS_INL_H_
#else
#define POINTREEL_PREDICT_HIT_MASK_CONTEXTS_INL_H_
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "predict/hit_mask_state.h"
#include "predict/neighbourhood-inl.h"
#include "predict/reference-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// What is coded, as far as the contexts look. A log range has 2048 steps per octave (linear within), 0: none.
struct HitMaskPlanes {
  SkewedPlane<std::int32_t> pattern;  // the row's bits up to the cell, its own in bit 0
  SkewedPlane<std::int32_t> log_range;
  SkewedPlane<std::int32_t> column_range;    // log range of the last hit in the column
  SkewedPlane<std::int32_t> column_history;  // the column's last eight bits, its own in bit 0

  explicit HitMaskPlanes(int columns)
      : pattern(columns, -1), log_range(columns), column_range(columns), column_history(columns, 0xFF) {}

  // The pattern of the row above up to kAhead columns to the right, bit kAhead: the cell above. Most of it is
  // the last step's, which is not loaded in other lanes than it was stored in: the processor would wait for
  // the store.
  static constexpr int kAhead = Wavefront::kLag - 1;
  POINTREEL_INLINE Int8 pattern_above(int step) const {
    return moved_up(load_ints<8>(pattern.at(step, -1)), *pattern.at(step, kAhead, -1));
  }
  // The same of two rows above, up to kAhead2 columns to the right.
  static constexpr int kAhead2 = 2 * Wavefront::kLag - 1;
  POINTREEL_INLINE Int8 pattern_above2(int step) const {
    return moved_up(pattern_above(step), *pattern.at(step, kAhead2, -2));
  }

  HWY_NOINLINE void remember(int step, const Int8& hits, const Float8& range_m) {
    // The float's exponent and 11 bits of its mantissa, 1 at 2^-4 m; what is nearer or beyond 2^12 m is
    // clamped.
    constexpr std::int32_t kLowest = (127 - 4) << 11;
    const Int8 code =
        larger(smaller(shifted_right<12>(bits_of(range_m)) - all_ints<8>(kLowest), all_ints<8>(0x7FFF)),
               all_ints<8>(1));
    const Int8 range = where(as_int_mask(seen(range_m)), code);
    store(range, log_range.at(step));
    store(select(range > all_ints<8>(0), range, load_ints<8>(column_range.at(step, 0, -1))),
          column_range.at(step));
    store(shifted_left<1>(load_ints<8>(pattern.at(step, -1))) | hits, pattern.at(step));
    store((shifted_left<1>(load_ints<8>(column_history.at(step, 0, -1))) | hits) & all_ints<8>(0xFF),
          column_history.at(step));
    pattern.keep_for_next_block(step);
    log_range.keep_for_next_block(step);
    column_range.keep_for_next_block(step);
    column_history.keep_for_next_block(step);
  }
};

// Class of the step between two log ranges: 0 unknown, 1 same surface, 2 slanted, 3 an edge.
POINTREEL_INLINE Int8 edge_class(const Int8& a, const Int8& b) {
  constexpr std::int32_t kSameSurface = 30;      // 1 to 1.5 %
  constexpr std::int32_t kSlantedSurface = 115;  // 4 to 6 %
  const Int8 one = all_ints<8>(1);
  const Int8 step = absolute(a - b);
  const Int8 known = one + where(step > all_ints<8>(kSameSurface - 1), one) +
                     where(step > all_ints<8>(kSlantedSurface - 1), one);
  return where(smaller(a, b) > all_ints<8>(0), known);
}

// How the last range above lies to the last one in the row: 0 near, 1 behind, 2 far behind, 3 before, 4 far
// before, 5 unknown.
POINTREEL_INLINE Int8 order_class(const Int8& above, const Int8& row) {
  constexpr std::int32_t kNearby = 60;
  constexpr std::int32_t kFarApart = 775;  // a factor of 1.3
  const Int8 one = all_ints<8>(1);
  const Int8 step = above - row;
  const Int8 side = select(step > all_ints<8>(0), one, all_ints<8>(3));
  const Int8 apart = side + where(absolute(step) > all_ints<8>(kFarApart), one);
  const Int8 known = where(absolute(step) > all_ints<8>(kNearby - 1), apart);
  return select(smaller(above, row) > all_ints<8>(0), known, all_ints<8>(5));
}

// Two classes per octave from 1 m on.
POINTREEL_INLINE Int8 range_class(const Int8& log_range) {
  return larger(smaller(shifted_right<10>(log_range) - all_ints<8>(8), all_ints<8>(15)), all_ints<8>(0));
}

// Share of hits among kCells cells in eight classes; the last one is for all of them.
template <std::size_t kCells>
inline constexpr auto kShareClasses = [] {
  std::array<std::uint8_t, kCells + 1> classes{};
  for (std::size_t hits = 0; hits <= kCells; ++hits)
    classes[hits] =
        static_cast<std::uint8_t>(hits == kCells ? 7 : std::min<std::size_t>(6, hits * 7 / kCells));
  return classes;
}();

// By the number of cells equal to the last one.
inline constexpr auto kRunClasses = [] {
  std::array<std::uint8_t, 33> classes{};
  for (std::size_t run = 0; run < classes.size(); ++run) {
    classes[run] = static_cast<std::uint8_t>(run < 4 ? run : run < 6 ? 4 : run < 10 ? 5 : run < 18 ? 6 : 7);
  }
  return classes;
}();

// 1 where the warped reference has a return.
POINTREEL_INLINE Int8 warped(const Int8& hits) {
  return where((hits & all_ints<8>(kWarpedHit | kWarpedFilled)) > all_ints<8>(0), all_ints<8>(1));
}

// Slots of the terms, but for what run_class() and density_class() add.
class HitMaskContexts {
 public:
  // Which of eight cells are sure, a bit each, which takes less than to find the slots. `reference`: nullptr
  // where there is none.
  POINTREEL_INLINE static std::uint32_t sure_cells(const HitMaskPlanes& planes,
                                                   const ReferencePlanes* reference, int step) {
    Int8 sure = amid_hits(load_ints<8>(planes.pattern.at(step, -1)), planes.pattern_above(step));
    if (reference != nullptr) sure = sure & warped(ReferenceView(*reference, step).hits(0));
    return lane_bits(as_float_mask(sure > all_ints<8>(0)));
  }

  HWY_NOINLINE void find(const HitMaskPlanes& planes, const Int8& row_range, int step) {
    const Int8 one = all_ints<8>(1);
    const Int8 here = load_ints<8>(planes.pattern.at(step, -1));
    const Int8 above = planes.pattern_above(step);    // bit kAhead: the cell above
    const Int8 above2 = planes.pattern_above2(step);  // bit kAhead2
    const Int8 west = here & one;
    const Int8 north = shifted_right<kAhead>(above) & one;
    const Int8 north_east = shifted_right<kAhead - 1>(above) & one;
    const Int8 north2 = shifted_right<kAhead2>(above2) & one;
    const Int8 range_above = load_ints<8>(planes.column_range.at(step, 0, -1));
    const auto log_range = [&](int columns_right, int rows_down) HWY_ATTR {
      return load_ints<8>(planes.log_range.at(step, columns_right, rows_down));
    };

    const Int8 near = west | shifted_left<1>(north) | shifted_left<2>(north2);
    store(near, slot[HitMaskState::kRow]);
    const Int8 last_range = select(row_range > all_ints<8>(0), row_range, range_above);
    store(near | shifted_left<3>(range_class(last_range)) |
              shifted_left<7>(order_class(range_above, row_range)),
          slot[HitMaskState::kRange]);
    store(shifted_left<3>(west) | shifted_left<4>(above & all_ints<8>((1 << (kAhead + 2)) - 1)),
          slot[HitMaskState::kRuns]);
    const Int8 above2_left = log_range(-1, -2), above2_here = log_range(0, -2);
    store(west | shifted_left<1>(north) | shifted_left<2>(edge_class(above2_here, log_range(1, -2))) |
              shifted_left<4>(edge_class(above2_left, above2_here)) |
              shifted_left<6>(edge_class(row_range, above2_left)) |
              shifted_left<8>(edge_class(log_range(0, -1), log_range(1, -1))),
          slot[HitMaskState::kEdges]);
    store(shifted_left<8>(north) | shifted_left<9>(north_east), slot[HitMaskState::kDensity]);
    store(here, pattern_);
    store(amid_hits(here, above), sure_);
    store((above & all_ints<8>(kWindowBits)) | shifted_left<kWindow>(above2 & all_ints<8>(kWindow2Bits)),
          window_);
    store(load_ints<8>(planes.column_history.at(step, 0, -1)), column_history_);
  }

  HWY_NOINLINE void find_reference(const HitMaskPlanes& planes, const ReferenceView& reference, int step) {
    const Int8 one = all_ints<8>(1);
    const Int8 coded = load_ints<8>(planes.pattern.at(step, -1));
    const Int8 coded_above = planes.pattern_above(step);
    const Int8 here = reference.hits(0), west = reference.hits(-1), east = reference.hits(1);
    const auto previous = [&](const Int8& hits) HWY_ATTR { return shifted_right<2>(hits) & one; };
    static_assert(kPreviousHit == 1 << 2);
    store(where(warped(here) == one, load_ints<8>(sure_)), sure_);
    const Int8 north_coded = shifted_right<kAhead>(coded_above);
    const Int8 north_east_coded = shifted_right<kAhead - 1>(coded_above);
    store((here & all_ints<8>(7)) | shifted_left<3>(previous(west)) | shifted_left<4>(previous(east)) |
              shifted_left<5>(coded & one) | shifted_left<6>(north_coded & one) |
              shifted_left<7>(warped(west)) | shifted_left<8>(warped(east)) |
              shifted_left<9>(warped(reference.hits(0, 1))) | shifted_left<10>(north_east_coded & one),
          slot[HitMaskState::kReference]);
    // Whether the reference was right about a neighbour.
    const auto differs = [&](const Int8& bit, const Int8& hits)
                             HWY_ATTR { return absolute((bit & one) - warped(hits)); };
    store((here & all_ints<8>(7)) | shifted_left<3>(differs(coded, west)) |
              shifted_left<4>(differs(shifted_right<1>(coded), reference.hits(-2))) |
              shifted_left<5>(differs(north_coded, reference.hits(0, -1))) |
              shifted_left<6>(differs(north_east_coded, reference.hits(1, -1))) |
              shifted_left<7>(coded & one) | shifted_left<8>(warped(west)) | shifted_left<9>(warped(east)),
          slot[HitMaskState::kAgreement]);
  }

  // All around are hits, and the reference has one, too.
  POINTREEL_INLINE bool is_sure(std::size_t cell) const { return sure_[cell] != 0; }

  POINTREEL_INLINE std::size_t run_class(std::size_t cell) const {
    const auto pattern = static_cast<std::uint32_t>(pattern_[cell]);
    const std::uint32_t last_ones = (pattern & 1) != 0 ? ~pattern : pattern;
    return kRunClasses[static_cast<std::size_t>(std::countr_zero(last_ones))];
  }
  POINTREEL_INLINE std::size_t density_class(std::size_t cell) const {
    const auto hits = [](std::int32_t pattern) HWY_ATTR {
      return static_cast<std::size_t>(std::popcount(static_cast<std::uint32_t>(pattern)));
    };
    const std::size_t in_row = hits(pattern_[cell] & 15);
    return kShareClasses<8>[hits(column_history_[cell])] |
           static_cast<std::size_t>(kShareClasses<kWindow + kWindow2>[hits(window_[cell])]) << 3 |
           (in_row == 4   ? 3U
            : in_row == 0 ? 0U
            : in_row > 2  ? 2U
                          : 1U)
               << 6;
  }

  alignas(32) std::int32_t slot[HitMaskState::kContexts][Wavefront::kRows];

 private:
  // 1 where the last three of the row are hits, and in the row above those from one column left to two right.
  static POINTREEL_INLINE Int8 amid_hits(const Int8& here, const Int8& above) {
    const Int8 around =
        (here & all_ints<8>(7)) | shifted_left<3>(shifted_right<kAhead - 2>(above) & all_ints<8>(15));
    return where(around == all_ints<8>(127), all_ints<8>(1));
  }

  // Windows of cells above: columns from -8 to kAhead and kAhead2 to the right.
  static constexpr int kAhead = HitMaskPlanes::kAhead, kAhead2 = HitMaskPlanes::kAhead2;
  static constexpr int kWindow = 9 + kAhead, kWindow2 = 9 + kAhead2;
  static constexpr std::int32_t kWindowBits = (1 << kWindow) - 1, kWindow2Bits = (1 << kWindow2) - 1;

  alignas(32) std::int32_t pattern_[Wavefront::kRows], window_[Wavefront::kRows],
      column_history_[Wavefront::kRows], sure_[Wavefront::kRows];
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
