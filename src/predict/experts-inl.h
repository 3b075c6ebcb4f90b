// The experts: what the ranges of eight cells could be, each from its own idea of the surface.

#if defined(POINTREEL_PREDICT_EXPERTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_EXPERTS_INL_H_
#undef POINTREEL_PREDICT_EXPERTS_INL_H_
#else
#define POINTREEL_PREDICT_EXPERTS_INL_H_
#endif

#include <array>
#include <cstdint>

#include "predict/local_fits-inl.h"
#include "predict/range_state.h"
#include "predict/reference-inl.h"
#include "predict/reference_bias-inl.h"
#include "predict/row_lines-inl.h"
#include "predict/row_memory-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// The order of the lanes is part of the format. Lane 0 is left for the blend (blend-inl.h). A mixture of
// eight has the first eight; the others only go into the blend.
enum Expert : std::uint8_t {  // of all frames
  kPlane = 1,                 // local fit
  kLeft = 2,                  // ranges seen nearby: the surfaces that may go on here
  kAboveRight = 3,
  kEdge = 4,  // behind the last depth edge of the row
  kLine = 8,  // local fits
  kParallel = 9,
  kAbove = 10,
};
enum KeyExpert : std::uint8_t {
  kKeyLine2 = 5,  // the last two returns of the row go on, in inverse range
  kKeyStep = 6,   // the step from above to above right, from the cell left
  kKeyAboveLeft = 7,
  kKeyAboveRight2 = 11,
  kKeyLeft2 = 12,
  kKeyLeft3 = 13,
  kKeyMeanLeft = 14,
  kKeyEarlierEdge = 15,
};
enum PredictedExpert : std::uint8_t {
  kReferenceHere = 5,      // the warped reference's range, its bias in the row corrected
  kReferenceRight = 6,     // its neighbours: what moved
  kReferenceLeftStep = 7,  // its step from the cell left
  kReferenceMean = 11,     // mean of three cells, plus the mean difference to what is coded around
  // Of effort max only:
  kPredictedLeft2 = 12,
  kPredictedLine2 = 13,
  kReferenceLeft = 14,
  kReferenceBelow = 15,
};

// A bit per expert that the blend is better off without: ranges taken from nearby as they are, which the
// mixture or the places among the bins take into account.
constexpr std::uint32_t not_blended(const CodingKind& kind) {
  return 1U << kAboveRight | 1U << kEdge | 1U << kAbove | (has_trust(kind) ? 1U << kLeft : 0U);
}

enum RowLineExpert : std::uint8_t {  // in place of the local fits, where has_row_lines()
  kRowLine = kPlane,
  kStepFromAbove = kLine,
  kRowParallel = kParallel,
};

// Triples of proposals whose places among the bins are contexts of the second stage.
using ExpertTriple = std::array<std::uint8_t, 3>;
inline constexpr std::array<ExpertTriple, StepModels::kPlaces> kKeyTriples = {
    {{kKeyStep, kLeft, kAbove}, {kPlane, kLine, kAboveRight}}};
inline constexpr std::array<ExpertTriple, StepModels::kPlaces> kPredictedTriples = {
    {{kReferenceHere, kLeft, kAbove}, {kPlane, kReferenceMean, kReferenceRight}}};

// Eight cells' proposals, a range per expert. Written in place: to copy them takes as long as to make some.
template <std::size_t kExperts>
struct Proposals {
  Float8 range_m[kExperts];

  POINTREEL_INLINE Proposals() {}
};

POINTREEL_INLINE Float8 inverted(const Float8& inverse_range) {
  const Float8 least = all<8>(1e-6F);
  return where(least <= inverse_range, all<8>(1) / larger(inverse_range, least));
}

// What several experts start from.
struct Surroundings {
  Float8 left, left2, above, above_left, above_right, above_right2;
  Float8 start;  // where nothing better is known; positive

  POINTREEL_INLINE Surroundings(const Neighbourhood& cells, const RowMemory& memory,
                                const Float8& reference_m)
      : left(memory.last_m()),
        left2(memory.before_last_m()),
        above(cells.range_m(0, -1)),
        above_left(cells.range_m(-1, -1)),
        above_right(cells.range_m(1, -1)),
        above_right2(cells.range_m(2, -1)) {
    constexpr float kFirstGuessM = 10;  // where a band has no return yet
    start = all<8>(kFirstGuessM);
    for (const Float8& guess : {reference_m, above_right, above_left, above, left})
      start = select(seen(guess), guess, start);
  }

  POINTREEL_INLINE Float8 or_start(const Float8& range_m) const {
    return select(seen(range_m), range_m, start);
  }
  // Extrapolations beyond these shares of the range left of the cell are noise.
  POINTREEL_INLINE Float8 if_likely(const Float8& range_m) const {
    const Mask<8> likely = (0.6F * start <= range_m) & (range_m <= 1.5F * start) & seen(range_m);
    return select(likely, range_m, start);
  }
  POINTREEL_INLINE Float8 line2() const {
    const Float8 inverse = 2 * (all<8>(1) / larger(left, all<8>(kSmallestRangeM))) -
                           all<8>(1) / larger(left2, all<8>(kSmallestRangeM));
    return if_likely(where(seen(left2), inverted(inverse)));
  }
  POINTREEL_INLINE Float8 step_from_above() const {
    return if_likely(where(seen(left) & seen(above) & seen(above_right), left + (above_right - above)));
  }
  POINTREEL_INLINE Float8 mean_left() const { return or_start(where(seen(left2), 0.5F * (left + left2))); }
};

// What all frames propose, but for the plane and the lines.
POINTREEL_INLINE void propose_from_around(const RowMemory& memory, const Surroundings& around,
                                          Float8* range_m) {
  range_m[0] = around.start;
  range_m[kLeft] = around.start;
  range_m[kAbove] = around.or_start(around.above);
  range_m[kAboveRight] = around.or_start(around.above_right);
  range_m[kEdge] = around.or_start(memory.edge_m());
}
POINTREEL_INLINE void propose_fits(const Neighbourhood& cells, const Surroundings& around, Float8* range_m) {
  const LocalFits fits = fit_locally(cells, around.start, around.above);
  range_m[kPlane] = around.if_likely(inverted(fits.plane));
  range_m[kLine] = around.if_likely(inverted(fits.line));
  range_m[kParallel] = around.if_likely(inverted(fits.parallel));
}
POINTREEL_INLINE void propose_row_lines(const Neighbourhood& cells, const RowLines& lines,
                                        const Surroundings& around, Float8* range_m) {
  range_m[kRowLine] = around.if_likely(inverted(lines.line()));
  range_m[kStepFromAbove] = around.step_from_above();
  range_m[kRowParallel] = around.if_likely(inverted(lines.parallel(cells.inverse_range(0, -1))));
}

HWY_NOINLINE inline void propose_for_key_frame(const Neighbourhood& cells, const RowMemory& memory,
                                               Proposals<kMostExperts>& proposals) {
  const Surroundings around(cells, memory, all<8>(0));
  Float8* range_m = proposals.range_m;
  propose_from_around(memory, around, range_m);
  propose_fits(cells, around, range_m);
  range_m[kKeyLine2] = around.line2();
  range_m[kKeyStep] = around.step_from_above();
  range_m[kKeyAboveLeft] = around.or_start(around.above_left);
  range_m[kKeyAboveRight2] =
      around.or_start(select(seen(around.above_right2), around.above_right2, around.above_right));
  range_m[kKeyLeft2] = around.or_start(around.left2);
  range_m[kKeyLeft3] = around.or_start(cells.range_m(-3));
  range_m[kKeyMeanLeft] = around.mean_left();
  range_m[kKeyEarlierEdge] = around.or_start(memory.earlier_edge_m());
}

// Mean difference of what is coded around a cell to the reference, where the two show the same surface.
POINTREEL_INLINE Float8 mean_difference(const Neighbourhood& cells, const ReferenceView& reference) {
  constexpr float kSameSurfaceM = 0.4F;
  Float8 sum = all<8>(0), count = all<8>(1);
  const auto add = [&](int column, int row) HWY_ATTR {
    const Float8 coded_m = cells.range_m(column, row);
    const Float8 reference_m = reference.range_m(column, row);
    const Mask<8> same = same_surface(coded_m, reference_m, kSameSurfaceM);
    sum = sum + where(same, coded_m - reference_m);
    count = count + where(same, all<8>(1));
  };
  for (int column = -4; column < 0; ++column) add(column, 0);
  for (int column = -2; column <= 2; ++column) add(column, -1);
  return sum / count;
}

// `lines`: only looked at by a kind that has them.
template <CodingKind kKind>
HWY_NOINLINE void propose_for_predicted_frame(const Neighbourhood& cells, const RowMemory& memory,
                                              const RowLines& lines, const ReferenceView& reference,
                                              const ReferenceBias& bias,
                                              Proposals<experts_of(kKind)>& proposals) {
  const Float8 here = reference.range_m(0);
  const Float8 west = reference.range_m(-1), east = reference.range_m(1);
  const Surroundings around(cells, memory, here);
  const Float8 shift = mean_difference(cells, reference);
  constexpr float kSmoothM = 0.3F;
  Float8* range_m = proposals.range_m;
  propose_from_around(memory, around, range_m);
  if constexpr (has_row_lines(kKind)) {
    propose_row_lines(cells, lines, around, range_m);
  } else {
    propose_fits(cells, around, range_m);
  }
  range_m[kReferenceHere] = around.or_start(bias.corrected(here));
  range_m[kReferenceLeftStep] =
      around.if_likely(where(seen(here) & seen(west) & seen(around.left), around.left + (here - west)));
  const Float8 reference_or_start = range_m[kReferenceHere];
  const auto or_here = [&](const Float8& m) HWY_ATTR { return select(seen(m), m, reference_or_start); };
  range_m[kReferenceRight] = or_here(bias.corrected(east));
  if constexpr (has_trust(kKind)) {
    range_m[kPredictedLeft2] = around.or_start(around.left2);
    range_m[kPredictedLine2] = around.line2();
    range_m[kReferenceLeft] = or_here(west);
    range_m[kReferenceBelow] = or_here(reference.range_m(0, 1));
  }
  {
    Float8 sum = here, count = all<8>(1);
    for (const Float8& beside : {west, east}) {
      const Mask<8> smooth = absolute(beside - here) <= all<8>(kSmoothM);
      sum = sum + where(smooth, beside);
      count = count + where(smooth, all<8>(1));
    }
    range_m[kReferenceMean] = around.or_start(where(seen(here), sum / count + shift));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
