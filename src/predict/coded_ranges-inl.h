// What a range model knows of the cells that are coded: the memory that its predictions look at.

#if defined(POINTREEL_PREDICT_CODED_RANGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_CODED_RANGES_INL_H_
#undef POINTREEL_PREDICT_CODED_RANGES_INL_H_
#else
#define POINTREEL_PREDICT_CODED_RANGES_INL_H_
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "predict/blend-inl.h"
#include "predict/range_quantiser.h"
#include "predict/range_rounding-inl.h"
#include "predict/row_lines-inl.h"
#include "predict/row_memory-inl.h"
#include "predict/step_context-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <std::size_t kExperts>
struct CodedRanges {
  float step_m;
  bool on_lattice;
  RangePlanes planes;
  RecentErrors<kExperts> errors;
  RowMemory memory;
  std::array<float, Wavefront::kRows> lattice_phase_m{};

  // Of the eight cells at hand.
  Proposals<kExperts> proposals;
  bool proposed = false;
  Float8 decoded_m;  // in the end what later cells see of it
  Int8 coded_steps;  // clipped

  CodedRanges(int columns, const RangeQuantiser& quantiser)
      : step_m(quantiser.step_m), on_lattice(quantiser.on_lattice()), planes(columns) {}

  // `phase_m`: per row, where its lattice has a point.
  void start_block(const std::array<float, Wavefront::kRows>& phase_m) {
    errors = RecentErrors<kExperts>(step_m);
    memory = RowMemory();
    lattice_phase_m = phase_m;
  }

  // Eight cells without returns so far.
  POINTREEL_INLINE void start_step() {
    proposed = false;
    decoded_m = all<8>(0);
    coded_steps = all_ints<8>(0);
  }

  // Of the cells whose range both sides know, a bit each; before the others.
  POINTREEL_INLINE void take_known(const Float8& range_m, std::uint32_t cells) {
    decoded_m = where(as_float_mask(bits_by_lane(cells) > all_ints<8>(0)), range_m);
  }

  // Where the bins around a proposal of the cell have their origin.
  POINTREEL_INLINE float quantised(float range_m, std::size_t cell) const {
    return on_lattice ? nearest_on_lattice(range_m, step_m, lattice_phase_m[cell]) : range_m;
  }

  POINTREEL_INLINE Float8 quantised(const Float8& range_m) const {  // of each cell
    return on_lattice ? nearest_on_lattice(range_m, step_m, load<8>(lattice_phase_m.data())) : range_m;
  }

  // What a cell decodes to, and the steps that its neighbours' contexts see.
  POINTREEL_INLINE float take(std::size_t cell, float range_m, std::int32_t steps_from_prediction) {
    const IntMask<8> lane = only_lane(cell);
    coded_steps = select(lane,
                         all_ints<8>(steps_from_prediction < -kMostContextSteps  ? -kMostContextSteps
                                     : steps_from_prediction > kMostContextSteps ? kMostContextSteps
                                                                                 : steps_from_prediction),
                         coded_steps);
    return set_decoded(cell, range_m > kSmallestRangeM ? range_m : kSmallestRangeM);
  }
  // The same of several, a bit each.
  POINTREEL_INLINE void take(std::uint32_t cells, const Float8& range_m, const Int8& steps_from_prediction) {
    const IntMask<8> taken = bits_by_lane(cells) > all_ints<8>(0);
    constexpr std::int32_t kMost = kMostContextSteps;
    coded_steps =
        where(taken, larger(smaller(steps_from_prediction, all_ints<8>(kMost)), all_ints<8>(-kMost)));
    decoded_m = select(as_float_mask(taken), larger(range_m, all<8>(kSmallestRangeM)), decoded_m);
  }
  // (Lane by lane in memory, whoever loads the eight would wait until all are written.)
  POINTREEL_INLINE float set_decoded(std::size_t cell, float range_m) {
    decoded_m = select(as_float_mask(only_lane(cell)), all<8>(range_m), decoded_m);
    return range_m;
  }

  // Later cells see ranges where in their bins they are likely to be: nearer to the prediction, by a share
  // `beside` of a step in the bins beside it and `beyond` in others, less where it was wrong lately (in
  // squared steps). On the lattice the reconstruction is exact.
  POINTREEL_INLINE void lean_to_prediction(float beside, float beyond, const Float8& squared_error) {
    constexpr float kPerSquaredStep = 0.5F;
    if (!proposed || on_lattice) return;
    const Float8 range_m = decoded_m;
    const Int8 first = larger(smaller(coded_steps, all_ints<8>(1)), all_ints<8>(-1));
    static_assert(kMostContextSteps == 2, "one step beyond the first at most");
    const Int8 second = coded_steps - first;
    const Float8 by_m =
        (beside * step_m) * as_floats(first) + ((beyond - beside) * step_m) * as_floats(second);
    const Float8 leant_m = range_m - by_m / (all<8>(1) + kPerSquaredStep * squared_error);
    decoded_m = where(seen(range_m), larger(leant_m, all<8>(kSmallestRangeM)));
  }

  // After the last of the eight. Returns 1 / range; 0 where there is no return.
  POINTREEL_INLINE Float8 remember(int step) {
    const Float8 range_m = decoded_m;
    const Float8 inverse = where(seen(range_m), all<8>(1) / larger(range_m, all<8>(kSmallestRangeM)));
    store(range_m, planes.range_m.at(step));
    store(inverse, planes.inverse_range.at(step));
    planes.keep_for_next_block(step);
    errors.add(proposals, range_m, proposed);
    memory.add(range_m);
    return inverse;
  }
  // The same with lines that follow the rows.
  POINTREEL_INLINE void remember(int step, RowLines& lines) {
    const Float8 last_m = memory.last_m();
    const Float8 inverse = remember(step);
    lines.add(decoded_m, inverse, last_m, Neighbourhood(planes, step).inverse_range(0, -1));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
