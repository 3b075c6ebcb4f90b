// Predicts and codes the ranges of one band of rows, along the wavefront.
//
//   propose -> weigh by recent errors -> mix -> code the bin -> reconstruct -> learn      (eight cells at a
//   time)
//
// What later predictions see follows from the reconstruction, so encoder and decoder see the same.

#if defined(POINTREEL_PREDICT_RANGE_MODEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#undef POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#else
#define POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#endif

#include <algorithm>
#include <type_traits>

#include "predict/band_coding.h"
#include "predict/coded_ranges-inl.h"
#include "predict/experts-inl.h"
#include "predict/max_second_stage-inl.h"
#include "predict/range_rounding-inl.h"
#include "predict/step_coder-inl.h"
#include "predict/trusted_mixture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <Effort kEffort, bool kPredicted>
class RangeModel {
 public:
  static constexpr CodingKind kKind = {kPredicted, kEffort};
  static constexpr std::size_t kExperts = experts_of(kKind), kMixed = mixed_of(kKind);

  RangeModel(int columns, const BandSetting& setting, BandState& state)
      : columns_(columns),
        ingredients_(setting.ingredients),
        coded_(columns, setting.quantiser),
        steps_(columns),
        lean_(std::min(kMostLean, kNoiseM / coded_.step_m)),
        state_(state) {}

  // `lattice_phase_m`: per row, where its lattice has a point.
  void start_block(const std::array<float, Wavefront::kRows>& lattice_phase_m) {
    coded_.start_block(lattice_phase_m);
    lines_ = RowLines(kSmoothLineRates);
    bias_ = ReferenceBias(coded_.step_m);
  }

  // Eight cells without returns so far.
  POINTREEL_INLINE void start_step() { coded_.start_step(); }

  // Looks at what is known of them; only needed before code().
  POINTREEL_INLINE void predict(int step, const ReferencePlanes* reference) {
    const Neighbourhood cells(coded_.planes, step);
    step_ = step;
    if constexpr (kPredicted) {
      const ReferenceView view(*reference, step);
      reference_m_ = view.range_m(0);
      propose_for_predicted_frame<kKind>(cells, coded_.memory, lines_, view, bias_, coded_.proposals);
    } else {
      propose_for_key_frame(cells, coded_.memory, coded_.proposals);
    }
    if (ingredients_.experts_off != 0) leave_out_experts();
    blend<kExperts, kMixed, not_blended(kKind)>(coded_.errors, cells, coded_.step_m, coded_.proposals,
                                                blended_);
    contexts_ = StepContexts(steps_, cells, step);
    if constexpr (!has_trust(kKind)) {
      contexts_.find_places(coded_.proposals.range_m, coded_.step_m,
                            kPredicted ? kPredictedTriples : kKeyTriples);
    }
    coded_.proposed = true;
  }

  // Those of them that hold a return whose range both sides know; before any is coded.
  POINTREEL_INLINE void take_known(const Float8& range_m, std::uint32_t cells) {
    coded_.take_known(range_m, cells);
  }

  // Codes the ranges of those that hold a return, a bit each, and gives back what a decoder gets, within half
  // a step of `range_m` (which a decoder ignores), beside those that are known; 0 where there is no return.
  // `first_row`: of the eight in the band.
  template <class Coder>
  POINTREEL_INLINE Float8 code(Coder& coder, std::uint32_t hits, int first_row, const Float8& range_m) {
    alignas(32) float range_of[Wavefront::kRows];
    store(range_m, range_of);
    const auto row_of = [&](std::size_t cell) { return first_row + static_cast<int>(cell); };
    for (std::uint32_t remaining = hits; remaining != 0; remaining = without_first_lane(remaining))
      start_cell(first_lane(remaining), row_of(first_lane(remaining)));
    for (std::uint32_t remaining = hits; remaining != 0; remaining = without_first_lane(remaining)) {
      const std::size_t cell = first_lane(remaining);
      code_cell(coder, cell, row_of(cell), range_of[cell]);
    }
    const Float8 decoded_m = coded_.decoded_m;
    for (std::uint32_t remaining = hits; remaining != 0; remaining = without_first_lane(remaining))
      learn_from(first_lane(remaining));
    return decoded_m;
  }

  // What later cells see of the eight; 0 where there is no return.
  POINTREEL_INLINE const Float8& decoded_m() const { return coded_.decoded_m; }

  // After the last of the eight: remembers them.
  POINTREEL_INLINE void remember(int step) {
    if constexpr (kPredicted) {
      // Before they lean towards what it corrects.
      if (coded_.proposed) bias_.add(decoded_m(), reference_m_);
    }
    if constexpr (!has_trust(kKind))
      coded_.lean_to_prediction(lean_, kLeanBeyond * lean_, blended_.squared_error);
    if constexpr (has_row_lines(kKind)) {
      coded_.remember(step, lines_);
    } else {
      coded_.remember(step);
    }
    store(coded_.coded_steps, steps_.at(step));
    steps_.keep_for_next_block(step);
  }

 private:
  using CellMixture = std::conditional_t<has_trust(kKind), TrustedMixture, Mixture<kMixed>>;
  using CellBins = Bins<CellMixture>;

  // Before any of them is coded.
  POINTREEL_INLINE void start_cell(std::size_t cell, int row) {
    if constexpr (has_trust(kKind)) {
      const int column = step_ - Wavefront::kLag * static_cast<int>(cell);
      const TrustedMixture mixture(state_.trust.trusts, blended_, cell,
                                   trust_classes(context_of(cell, row), blended_.error_class[cell],
                                                 blended_.blend_m[cell], column, columns_));
      const auto origin = mixture.likeliest_origin(coded_.step_m);
      origin_[cell] = origin.expert;
      bins_[cell].start(mixture, coded_.quantised(origin.range_m, cell), coded_.step_m);
    } else {
      bins_[cell].start(Mixture<kMixed>(state_.ranges.mixture, blended_, cell),
                        coded_.quantised(blended_.blend_m[cell], cell), coded_.step_m);
    }
  }

  template <class Coder>
  POINTREEL_INLINE void code_cell(Coder& coder, std::size_t cell, int row, float range_m) {
    CellBins& bins = bins_[cell];
    const std::int32_t wanted = Coder::kDecodes ? 0 : rounded((range_m - bins.origin_m()) / coded_.step_m);
    const StepContext context = context_of(cell, row);
    std::int32_t steps = 0;
    if constexpr (has_trust(kKind)) {
      const auto proposed = bins.mixture().steps_from(bins.origin_m(), 1 / coded_.step_m);
      steps = coded_steps(coder, bins,
                          MaxSecondStage(state_.trust.questions, context, proposed, origin_[cell]), wanted);
    } else {
      steps = coded_steps(coder, bins, SecondStage(state_.ranges.steps, context, ingredients_.second_stage),
                          wanted);
    }
    const float decoded_m = bins.origin_m() + static_cast<float>(steps) * coded_.step_m;
    reconstructed_m_[cell] = coded_.take(cell, decoded_m, steps);
  }

  // What it teaches the mixture, and what later cells see of it: after all of them are coded.
  POINTREEL_INLINE void learn_from(std::size_t cell) {
    const CellBins& bins = bins_[cell];
    if constexpr (has_trust(kKind)) {
      const float likely_m = bins.mixture().learn(*bins.lower, *bins.upper, reconstructed_m_[cell],
                                                  coded_.step_m, state_.trust.trusts);
      // On the lattice the reconstruction is exact.
      if (!coded_.on_lattice)
        coded_.set_decoded(cell, likely_m > kSmallestRangeM ? likely_m : kSmallestRangeM);
    } else {
      bins.mixture().learn(*bins.lower, *bins.upper, ingredients_, state_.ranges.mixture);
    }
  }

  template <class Coder, class Stage>
  static POINTREEL_INLINE std::int32_t coded_steps(Coder& coder, CellBins& bins, const Stage& stage,
                                                   std::int32_t wanted) {
    return StepCoder<Coder, CellMixture, Stage>(coder, bins, stage).code(wanted);
  }
  POINTREEL_INLINE StepContext context_of(std::size_t cell, int row) const {
    return contexts_.of(cell, row, blended_.error_class[cell], blended_.spread_class[cell]);
  }
  void leave_out_experts() {
    for (std::size_t k = 0; k < kExperts; ++k) {
      if ((ingredients_.experts_off >> k & 1) != 0) coded_.proposals.range_m[k] = coded_.proposals.range_m[0];
    }
  }

  int columns_;
  Ingredients ingredients_;
  CodedRanges<kExperts> coded_;
  SkewedPlane<std::int32_t> steps_;  // as coded, clipped
  // Of a step: as far as noise goes at most. In coarse steps leaning would follow the prediction's own
  // errors.
  static constexpr float kMostLean = 0.3F, kNoiseM = 0.015F, kLeanBeyond = 0.4F;
  float lean_;
  RowLines lines_ = RowLines(kSmoothLineRates);
  ReferenceBias bias_ = ReferenceBias(coded_.step_m);
  BandState& state_;

  // Of the eight cells at hand.
  BlendedProposals<kMixed> blended_;
  int step_ = 0;
  Float8 reference_m_ = all<8>(0);  // the reference's ranges
  StepContexts contexts_;
  std::size_t origin_[Wavefront::kRows];  // the expert around whose proposal the bins lie
  CellBins bins_[Wavefront::kRows];
  float reconstructed_m_[Wavefront::kRows];
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
