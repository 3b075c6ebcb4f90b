// Predicts and codes the ranges of one band of rows, along the wavefront.
//
//   propose -> weigh by recent errors -> mix -> code the bin -> reconstruct -> learn      (eight cells at a
//   time)
//
// The reconstruction feeds all later predictions, so encoder and decoder see the same.

#if defined(POINTREEL_PREDICT_RANGE_MODEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#undef POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#else
#define POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#endif

#include <type_traits>

#include "predict/band_coding.h"
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
  static constexpr std::size_t kExperts = experts_of(kKind);

  RangeModel(int columns, const BandSetting& setting, BandState& state)
      : columns_(columns),
        step_m_(setting.quantiser.step_m),
        on_lattice_(setting.quantiser.on_lattice()),
        ingredients_(setting.ingredients),
        planes_(columns),
        errors_(columns),
        steps_(columns),
        state_(state) {}

  // `lattice_phase_m`: per row, where its lattice has a point.
  void start_block(bool first, const std::array<float, Wavefront::kRows>& lattice_phase_m) {
    if (!first) {
      planes_.start_next_block();
      errors_.start_next_block();
      steps_.start_next_block();
    }
    memory_ = RowMemory();
    lattice_phase_m_ = lattice_phase_m;
  }

  // Eight cells without returns so far.
  POINTREEL_INLINE void start_step() {
    predicted_ = false;
    store(all<8>(0), decoded_m_);
    store(all_ints<8>(0), coded_steps_);
  }

  // Looks at what is known of them; only needed before code().
  POINTREEL_INLINE void predict(int step, const ReferencePlanes* reference) {
    const Neighbourhood cells(planes_, step);
    step_ = step;
    if constexpr (kPredicted) {
      proposals_ = propose_for_predicted_frame<kExperts>(cells, memory_, ReferenceView(*reference, step));
    } else {
      proposals_ = propose_for_key_frame<kExperts>(cells, memory_);
    }
    if (ingredients_.experts_off != 0) leave_out_experts();
    blend<kExperts>(errors_, cells, step, step_m_, proposals_, blended_);
    contexts_ = StepContexts(steps_, cells, step);
    predicted_ = true;
  }

  // One of them holds a return whose range both sides know.
  POINTREEL_INLINE float take_known(std::size_t cell, float range_m) { return decoded_m_[cell] = range_m; }

  // Looks at one of them that holds a return: before any of them is coded. `row`: in the band.
  POINTREEL_INLINE void start(std::size_t cell, int row) {
    if constexpr (has_trust(kKind)) {
      const int column = step_ - Wavefront::kLag * static_cast<int>(cell);
      const TrustedMixture mixture(state_.trust.trusts, blended_, cell,
                                   trust_classes(context_of(cell, row), blended_.error_class[cell],
                                                 blended_.blend_m[cell], column, columns_));
      const auto origin = mixture.likeliest_origin(step_m_);
      origin_[cell] = origin.expert;
      bins_[cell].start(mixture, quantised(origin.range_m, cell), step_m_);
    } else {
      bins_[cell].start(Mixture<kExperts>(state_.ranges.mixture, blended_, cell),
                        quantised(blended_.blend_m[cell], cell), step_m_);
    }
  }

  // Codes its range and gives back the reconstruction, within half a step of `range_m` (which a decoder
  // ignores). `row`: in the band.
  template <class Coder>
  POINTREEL_INLINE float code(Coder& coder, std::size_t cell, int row, float range_m) {
    CellBins& bins = bins_[cell];
    const std::int32_t wanted = Coder::kDecodes ? 0 : rounded((range_m - bins.origin_m()) / step_m_);
    const StepContext context = context_of(cell, row);
    std::int32_t steps;
    if constexpr (has_trust(kKind)) {
      const auto proposed = bins.mixture().steps_from(bins.origin_m(), 1 / step_m_);
      steps = coded_steps(coder, bins,
                          MaxSecondStage(state_.trust.questions, context, proposed, origin_[cell]), wanted);
    } else {
      steps = coded_steps(coder, bins, SecondStage(state_.ranges.steps, context, ingredients_.second_stage),
                          wanted);
    }
    const float decoded_m = bins.origin_m() + static_cast<float>(steps) * step_m_;
    decoded_m_[cell] = decoded_m > kSmallestRangeM ? decoded_m : kSmallestRangeM;
    coded_steps_[cell] = steps < -kMostContextSteps  ? -kMostContextSteps
                         : steps > kMostContextSteps ? kMostContextSteps
                                                     : steps;
    return decoded_m_[cell];
  }

  // What it teaches the mixture, and what later cells see of it: after all of them are coded.
  POINTREEL_INLINE void learn(std::size_t cell) {
    const CellBins& bins = bins_[cell];
    if constexpr (has_trust(kKind)) {
      const float likely_m =
          bins.mixture().learn(*bins.lower, *bins.upper, decoded_m_[cell], step_m_, state_.trust.trusts);
      // On the lattice the reconstruction is exact.
      if (!on_lattice_) decoded_m_[cell] = likely_m > kSmallestRangeM ? likely_m : kSmallestRangeM;
    } else {
      bins.mixture().learn(*bins.lower, *bins.upper, ingredients_, state_.ranges.mixture);
    }
  }

  // What later cells see of the eight; 0 where there is no return.
  POINTREEL_INLINE Float8 decoded_m() const { return load<8>(decoded_m_); }

  // After the last of the eight: remembers them.
  POINTREEL_INLINE void remember(int step) {
    const Float8 decoded_m = this->decoded_m();
    store(decoded_m, planes_.range_m.at(step));
    store(where(seen(decoded_m), all<8>(1) / larger(decoded_m, all<8>(kSmallestRangeM))),
          planes_.inverse_range.at(step));
    store(load_ints<8>(coded_steps_), steps_.at(step));
    remember_errors(proposals_, decoded_m, predicted_, step_m_, step, errors_);
    memory_.add(decoded_m);
  }

 private:
  using CellMixture = std::conditional_t<has_trust(kKind), TrustedMixture, Mixture<kExperts>>;
  using CellBins = Bins<CellMixture>;

  template <class Coder, class Stage>
  static POINTREEL_INLINE std::int32_t coded_steps(Coder& coder, CellBins& bins, const Stage& stage,
                                                   std::int32_t wanted) {
    return StepCoder<Coder, CellMixture, Stage>(coder, bins, stage).code(wanted);
  }
  POINTREEL_INLINE StepContext context_of(std::size_t cell, int row) const {
    return contexts_.of(cell, row, blended_.error_class[cell], blended_.spread_class[cell]);
  }
  POINTREEL_INLINE float quantised(float origin_m, std::size_t cell) const {
    return on_lattice_ ? nearest_on_lattice(origin_m, step_m_, lattice_phase_m_[cell]) : origin_m;
  }
  void leave_out_experts() {
    for (std::size_t k = 0; k < kExperts; ++k) {
      if ((ingredients_.experts_off >> k & 1) != 0) proposals_.range_m[k] = proposals_.range_m[0];
    }
  }

  int columns_;
  float step_m_;
  bool on_lattice_;
  Ingredients ingredients_;
  RangePlanes planes_;
  ErrorPlanes<kExperts> errors_;
  SkewedPlane<std::int32_t> steps_;  // clipped
  RowMemory memory_;
  BandState& state_;
  std::array<float, Wavefront::kRows> lattice_phase_m_{};

  // Of the eight cells at hand.
  Proposals<kExperts> proposals_;
  BlendedProposals<kExperts> blended_;
  int step_ = 0;
  StepContexts contexts_;
  std::size_t origin_[Wavefront::kRows];  // the expert around whose proposal the bins lie
  CellBins bins_[Wavefront::kRows];
  alignas(32) float decoded_m_[Wavefront::kRows];
  alignas(32) std::int32_t coded_steps_[Wavefront::kRows];
  bool predicted_ = false;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
