// Which cells of the sensor grid hold a return: one bit per cell, coded along the wavefront between the
// ranges.
//
// When a cell's bit is coded both sides know the hits and the decoded ranges of all cells before it, and all
// of the reference.

#if defined(POINTREEL_PREDICT_HIT_MASK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_HIT_MASK_INL_H_
#undef POINTREEL_PREDICT_HIT_MASK_INL_H_
#else
#define POINTREEL_PREDICT_HIT_MASK_INL_H_
#endif

#include <bit>

#include "predict/bit_mixing-inl.h"
#include "predict/hit_mask_contexts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <Effort kEffort, bool kPredicted>
class HitMaskModel {
 public:
  HitMaskModel(int columns, HitMaskState& state) : planes_(columns), state_(state) {}

  void start_block() { row_range_ = all_ints<8>(0); }

  // Eight cells; outside the image hits are the better guess.
  POINTREEL_INLINE void start_step() { hits_ = (1U << Wavefront::kRows) - 1; }

  // Those of them that are sure to be hits, all but once in a while, and enough to be coded at once; a bit
  // each. (Effort max, whose frames by themselves are balanced's, always asks its contexts.)
  POINTREEL_INLINE std::uint32_t sure_cells(int step, std::uint32_t inside,
                                            const ReferencePlanes* reference) const {
    if constexpr (kEffort == Effort::max) {
      return 0;
    } else {
      constexpr int kLeast = kEffort == Effort::fast ? 2 : Wavefront::kRows;
      const std::uint32_t sure =
          HitMaskContexts::sure_cells(planes_, kPredicted ? reference : nullptr, step) & inside;
      return std::popcount(sure) >= kLeast ? sure : 0;
    }
  }
  // True when they are all hits; otherwise each has to be coded.
  template <class Coder>
  POINTREEL_INLINE bool code_together(Coder& coder, std::uint32_t cells, bool hits) {
    return code_counted(coder, state_.together[static_cast<std::size_t>(std::popcount(cells))], hits);
  }

  // Looks at what is known of them; only needed before code().
  POINTREEL_INLINE void predict(int step, const ReferencePlanes* reference) {
    contexts_.find(planes_, row_range_, step);
    if constexpr (kPredicted) contexts_.find_reference(planes_, ReferenceView(*reference, step), step);
  }

  // Codes the bit of one of them; a decoder passes anything and gets it. `row`: in the band.
  template <class Coder>
  POINTREEL_INLINE bool code(Coder& coder, std::size_t cell, int row, bool hit) {
    constexpr std::size_t kUsed = kEffort == Effort::fast ? HitMaskState::kFastContexts
                                  : kPredicted            ? std::size_t{HitMaskState::kContexts}
                                                          : HitMaskState::kKeyContexts;
    constexpr float kRate = 0.02F;
    if (contexts_.is_sure(cell)) return code_sure(coder, cell, hit);
    float* terms[kUsed];
    for (std::size_t i = 0; i < kUsed; ++i) {
      auto slot = static_cast<std::size_t>(contexts_.slot[i][cell]);
      if (i == HitMaskState::kRow) slot |= static_cast<std::size_t>(row) * HitMaskState::kSlots[i];
      if (i == HitMaskState::kRuns) slot |= contexts_.run_class(cell);
      if (i == HitMaskState::kDensity) slot |= contexts_.density_class(cell);
      terms[i] = &state_.terms[i][slot];
    }
    float move = 0;
    hit = code_sum(coder, 0, terms, kRate, hit, move);
    remember_hit(cell, hit);
    return hit;
  }

  // After the last of the eight: remembers them and their decoded ranges, 0 where there is none.
  POINTREEL_INLINE void remember(int step, const Float8& range_m) {
    planes_.remember(step, bits_by_lane(hits_), range_m);
    const Int8 range = load_ints<8>(planes_.log_range.at(step));
    row_range_ = select(range > all_ints<8>(0), range, row_range_);
  }

 private:
  // Amid hits, mixing would only take time.
  template <class Coder>
  POINTREEL_INLINE bool code_sure(Coder& coder, std::size_t cell, bool hit) {
    hit = code_counted(
        coder, state_.sure[static_cast<std::size_t>(contexts_.slot[HitMaskState::kEdges][cell])], hit);
    remember_hit(cell, hit);
    return hit;
  }
  POINTREEL_INLINE void remember_hit(std::size_t cell, bool hit) { hits_ &= ~((hit ? 0U : 1U) << cell); }

  HitMaskPlanes planes_;
  HitMaskState& state_;
  Int8 row_range_;  // of the last hit in each row

  // Of the eight cells at hand.
  HitMaskContexts contexts_;
  std::uint32_t hits_;  // a bit each
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
