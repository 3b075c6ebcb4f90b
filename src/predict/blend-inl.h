// The blend: the experts' proposals weighed by how well each did along the row; eight cells at once.

#if defined(POINTREEL_PREDICT_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_BLEND_INL_H_
#undef POINTREEL_PREDICT_BLEND_INL_H_
#else
#define POINTREEL_PREDICT_BLEND_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "predict/experts-inl.h"
#include "predict/neighbourhood-inl.h"
#include "predict/range_state.h"
#include "predict/recent_errors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Of eight cells: the proposals of the mixture's experts with the blend in lane 0, what scales their
// distributions, and the class of the blend's recent error.
template <std::size_t kMixed>
struct BlendedProposals {
  TurnedLanes<kMixed / 4> range_m;
  TurnedLanes<kMixed / 4> inverse_scale;  // sqrt(floor / mean squared error) / step
  alignas(32) float blend_m[8];
  alignas(32) std::int32_t error_class[8];
  alignas(32) std::int32_t spread_class[8];  // the same for how far the proposals lie from the blend
  Float8 squared_error;                      // of the blend, in squared steps

  POINTREEL_INLINE BlendedProposals() {}
};

// Half octaves from a mean squared error in squared steps.
POINTREEL_INLINE Int8 error_classes(const Float8& squared_steps) {
  constexpr float kFloor = 0.0016F;  // below it errors are the quantiser's
  const Int8 octave = shifted_right<23>(bits_of(squared_steps + all<8>(kFloor)));
  return smaller(octave - all_ints<8>(127 + kFirstClassLog2),
                 all_ints<8>(static_cast<std::int32_t>(kErrorClasses) - 1));
}

// The blend of eight cells' proposals: their mean, weighted by the inverse fourth power of their recent
// errors.
struct Blend {
  Float8 range_m;
  Float8 squared_error;  // recent, in squared steps
  Float8 spread;         // of the proposals around it, the same

  POINTREEL_INLINE Blend() {}
};

// What errors are at least, in square metres.
POINTREEL_INLINE float error_floor(float step_m) {
  return step_m * step_m * 0.08F + 1e-5F;
}

// Replaces lane 0 of `proposals` by the blend of the others, but for those of `kNotBlended`, a bit each.
// `precision`: of each proposal, 1 / its recent squared error.
template <std::size_t kExperts, std::uint32_t kNotBlended = 0>
POINTREEL_INLINE Blend weigh(const RecentErrors<kExperts>& errors, const Neighbourhood& cells, float step_m,
                             Proposals<kExperts>& proposals, Float8 (&precision)[kExperts]) {
  const float squared_step = step_m * step_m;
  const float floor = error_floor(step_m);
  const Float8 beyond_gap = errors.beyond_gap_m2(cells);
  Float8 weighted = all<8>(0), total = all<8>(0);
  Float8 weight[kExperts];
  Blend blend;
  const auto is_blended = [](std::size_t k) { return k != 0 && (kNotBlended >> k & 1) == 0; };
  for (std::size_t k = 0; k < kExperts; ++k) {
    const Float8 mean_square = errors.mean_square_m2(k) + beyond_gap;
    precision[k] = all<8>(1) / (mean_square + all<8>(floor));
    if (k == 0) blend.squared_error = (1 / squared_step) * mean_square;
    if (is_blended(k)) {
      weight[k] = precision[k] * precision[k];
      weighted = weighted + weight[k] * proposals.range_m[k];
      total = total + weight[k];
    }
  }
  blend.range_m = weighted / total;
  proposals.range_m[0] = blend.range_m;
  Float8 spread = all<8>(0);
  for (std::size_t k = 1; k < kExperts; ++k) {
    if (!is_blended(k)) continue;
    const Float8 away_m = proposals.range_m[k] - blend.range_m;
    spread = spread + weight[k] * (away_m * away_m);
  }
  blend.spread = (1 / squared_step) * (spread / total);
  return blend;
}

// The same with all that the mixture looks at, which is one of the first kMixed experts.
template <std::size_t kExperts, std::size_t kMixed, std::uint32_t kNotBlended>
HWY_NOINLINE void blend(const RecentErrors<kExperts>& errors, const Neighbourhood& cells, float step_m,
                        Proposals<kExperts>& proposals, BlendedProposals<kMixed>& blended) {
  Float8 precision[kExperts];
  const Blend blend = weigh<kExperts, kNotBlended>(errors, cells, step_m, proposals, precision);
  blended.squared_error = blend.squared_error;
  store(blend.range_m, blended.blend_m);
  store(error_classes(blend.squared_error), blended.error_class);
  store(error_classes(blend.spread), blended.spread_class);
  const float floor = error_floor(step_m);
  Float8 inverse_scale[kMixed];
  for (std::size_t k = 0; k < kMixed; ++k)
    inverse_scale[k] = (1 / step_m) * square_root(floor * precision[k]);
  for (std::size_t g = 0; g < kMixed / 4; ++g) {
    const Float8* r = &proposals.range_m[4 * g];
    const Float8* s = &inverse_scale[4 * g];
    store_turned(r[0], r[1], r[2], r[3], g, blended.range_m);
    store_turned(s[0], s[1], s[2], s[3], g, blended.inverse_scale);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
