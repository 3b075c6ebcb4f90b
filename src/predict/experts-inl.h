// The experts: what the range of a cell could be, each from its own idea of the surface.

#if defined(POINTREEL_PREDICT_EXPERTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_EXPERTS_INL_H_
#undef POINTREEL_PREDICT_EXPERTS_INL_H_
#else
#define POINTREEL_PREDICT_EXPERTS_INL_H_
#endif

#include "predict/causal_canvas.h"
#include "predict/local_fits-inl.h"
#include "predict/range_config.h"
#include "predict/range_state.h"
#include "predict/row_memory.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Extrapolations beyond these shares of the range left of the cell are noise.
inline constexpr float kNearest = 0.6F, kFarthest = 1.5F, kAny = 1e30F;
alignas(64) inline constexpr float kNearestShares[kExperts] = {0,        kNearest, kNearest,
                                                               kNearest, kNearest, kNearest};
alignas(64) inline constexpr float kFarthestShares[kExperts] = {
    kAny, kFarthest, kFarthest, kFarthest, kFarthest, kFarthest, kAny, kAny,
    kAny, kAny,      kAny,      kAny,      kAny,      kAny,      kAny, kAny};

HWY_INLINE float inverted(float inverse_range) {
  return inverse_range > 1e-6F ? 1 / inverse_range : 0;
}

// One range per expert in metres, all positive. Lane 0 is left for the blend (mixture-inl.h).
template <class Ingredients>
HWY_INLINE Float16 propose_ranges(const CausalCanvas& canvas, std::size_t index, int column,
                                  const RowMemory& memory) {
  constexpr float kFirstGuessM = 10;  // where a band has no return yet

  const float* here = canvas.range_m(index);
  const float* above = here - canvas.stride();
  const float left = memory.last_m(column);
  const float left2 = memory.before_last_m(column);
  const float up = above[0];
  float start = left;
  if (!(start > 0)) start = up;
  if (!(start > 0)) start = above[-1];
  if (!(start > 0)) start = above[1];
  if (!(start > 0)) start = kFirstGuessM;
  // Proposals that there is no evidence for are 0 at first, then `start`.
  alignas(64) float seen_m[kExperts];
  seen_m[0] = start;
  seen_m[1] = left2 > 0 ? inverted(2 / left - 1 / left2) : 0;
  seen_m[5] = left > 0 && up > 0 && above[1] > 0 ? left + (above[1] - up) : 0;
  // Ranges seen nearby: the surfaces that may go on here.
  seen_m[6] = start;
  seen_m[7] = up;
  seen_m[8] = above[-1];
  seen_m[9] = above[1];
  seen_m[10] = above[2] > 0 ? above[2] : above[1];
  seen_m[11] = left2;
  seen_m[12] = here[-3];
  seen_m[13] = left2 > 0 ? 0.5F * (left + left2) : 0;
  seen_m[14] = memory.edge_m();
  seen_m[15] = memory.earlier_edge_m();
  // Linear in inverse range, as planes are.
  const LocalFits fits = fit_locally(canvas, index, start, up);
  seen_m[2] = seen_m[3] = seen_m[4] = 0;
  const Float16 raw_m =
      with_lane<2>(with_lane<3>(with_lane<4>(load<16>(seen_m), inverted(fits.parallel)), inverted(fits.line)),
                   inverted(fits.plane));
  const Mask<16> usable = (start * load<16>(kNearestShares) <= raw_m) &
                          (raw_m <= start * load<16>(kFarthestShares)) &
                          (all<16>(CausalCanvas::kSmallestRangeM) <= raw_m);
  const Float16 proposals_m = select(usable, raw_m, all<16>(start));
  if constexpr (Ingredients::kExpertsOff != 0) {
    alignas(64) float left_m[kExperts];
    store(proposals_m, left_m);
    for (std::size_t k = 0; k < kExperts; ++k) {
      if ((Ingredients::kExpertsOff >> k & 1) != 0) left_m[k] = start;
    }
    return load<16>(left_m);
  }
  return proposals_m;
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
