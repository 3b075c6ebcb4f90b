// The experts of effort fast: three that cost little, for eight cells at once.

#if defined(POINTREEL_PREDICT_FAST_EXPERTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_FAST_EXPERTS_INL_H_
#undef POINTREEL_PREDICT_FAST_EXPERTS_INL_H_
#else
#define POINTREEL_PREDICT_FAST_EXPERTS_INL_H_
#endif

#include "predict/experts-inl.h"
#include "predict/row_lines-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr LineRates kFastLineRates = {0.6F, 0.18F};  // the line is all that extrapolates
inline constexpr std::size_t kFastExperts = 4;              // lane 0 is left for the blend

POINTREEL_INLINE void propose_fast(const Neighbourhood& cells, const RowLines& lines,
                                   const Surroundings& around, Proposals<kFastExperts>& proposals) {
  Float8* range_m = proposals.range_m;
  range_m[1] = around.if_likely(inverted(lines.line()));
  range_m[2] = around.if_likely(inverted(lines.parallel(cells.inverse_range(0, -1))));
  range_m[3] = around.start;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
