// Predicts and codes the ranges of one band of rows, cell by cell in raster order.
//
//   propose -> weigh by recent errors -> mix -> code the bin -> reconstruct -> learn
//
// The reconstruction feeds all later predictions, so encoder and decoder see the same.

#if defined(POINTREEL_PREDICT_RANGE_MODEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#undef POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#else
#define POINTREEL_PREDICT_RANGE_MODEL_INL_H_
#endif

#include <vector>

#include "predict/band_coding.h"
#include "predict/experts-inl.h"
#include "predict/step_coder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <class Ingredients = AllIngredients>
class RangeModel {
 public:
  RangeModel(const Band& band, int columns, const RangeQuantiser& quantiser, RangeModelState& state)
      : step_m_(quantiser.step_m),
        on_lattice_(quantiser.on_lattice()),
        canvas_(band.rows, columns),
        errors_(columns),
        steps_(static_cast<std::size_t>(band.rows + CausalCanvas::kRowsAbove) * canvas_.stride(), kNoSteps),
        state_(state) {}

  // Before the first cell of each row. `phase_m`: where the row's lattice has a point.
  void start_row(int row, float phase_m) {
    row_ = row;
    phase_m_ = phase_m;
    memory_.start_row();
    errors_.start_row();
  }

  // Codes the range of a cell that holds a return and gives back the reconstruction, within half a step of
  // `range_m` (which a decoder ignores). Cells of a row from left to right.
  template <class Coder>
  float code(Coder& coder, int column, float range_m) {
    constexpr float kUnknownSquaredSteps = 30;  // the experts' error where no neighbour is known
    const std::size_t index = canvas_.index(row_, column);
    const float step_m = step_m_;
    const Float16 proposals_m = propose_ranges<Ingredients>(canvas_, index, column, memory_);
    const Float16 errors =
        recent_errors(errors_, canvas_, index, column, kUnknownSquaredSteps * step_m * step_m);
    const Mixture mixture(state_.mixture, proposals_m, errors, step_m);
    const float origin_m = on_lattice_ ? on_lattice(mixture.blend_m()) : mixture.blend_m();

    const std::size_t above = index - canvas_.stride();
    const StepContext context(&steps_[index], &steps_[above], canvas_.range_m(index)[-1] > 0,
                              *canvas_.range_m(above) > 0, row_, mixture.blend_class());
    Mixture::Border lower, upper;
    const std::int32_t wanted = Coder::kDecodes ? 0 : rounded((range_m - origin_m) / step_m);
    const std::int32_t steps =
        StepCoder<Coder, Ingredients>(coder, state_.steps, mixture, context, origin_m, step_m)
            .code(wanted, lower, upper);
    mixture.learn<Ingredients>(lower, upper, state_.mixture);

    const float decoded_m = at_least_smallest(origin_m + static_cast<float>(steps) * step_m);
    store_errors(mixture.proposals_m(), decoded_m, errors_.at(0, column));
    memory_.add(column, decoded_m);
    canvas_.set(index, decoded_m);
    steps_[index] = clipped_steps(steps);
    return decoded_m;
  }

 private:
  static float at_least_smallest(float range_m) {
    return range_m > CausalCanvas::kSmallestRangeM ? range_m : CausalCanvas::kSmallestRangeM;
  }
  // Hostile streams reach beyond the integers, where processors disagree about conversions.
  static std::int32_t rounded(float x) {
    constexpr float kMost = 1 << 30;
    x = x < kMost ? x : kMost;
    x = x > -kMost ? x : -kMost;
    return x < 0 ? -static_cast<std::int32_t>(0.5F - x) : static_cast<std::int32_t>(x + 0.5F);
  }
  float on_lattice(float range_m) const {
    return static_cast<float>(rounded((range_m - phase_m_) / step_m_)) * step_m_ + phase_m_;
  }

  float step_m_;
  bool on_lattice_;
  CausalCanvas canvas_;
  RowMemory memory_;
  ErrorHistory errors_;
  std::vector<std::uint8_t> steps_;  // clipped
  RangeModelState& state_;
  int row_ = 0;
  float phase_m_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
