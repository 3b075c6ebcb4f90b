// The blend: the experts' proposals weighed by how well each did around the cell; eight cells at once.

#if defined(POINTREEL_PREDICT_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_BLEND_INL_H_
#undef POINTREEL_PREDICT_BLEND_INL_H_
#else
#define POINTREEL_PREDICT_BLEND_INL_H_
#endif

#include "predict/experts-inl.h"
#include "predict/neighbourhood-inl.h"
#include "predict/range_state.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr float kLargestSquaredErrorM2 = 4;  // an edge, whatever its depth

template <std::size_t kExperts>
using ErrorPlanes = SkewedPlane<float, static_cast<int>(kExperts)>;

// Mean squared errors of the experts along each of eight rows: what is right on a kerb stays so. Clipped, so
// that depth edges, where all are wrong, say little.
template <std::size_t kExperts>
struct RowErrors {
  Float8 mean_square_m2[kExperts];

  POINTREEL_INLINE RowErrors() {}
  POINTREEL_INLINE explicit RowErrors(float step_m) {
    for (Float8& mean : mean_square_m2) mean = all<8>(step_m * step_m);
  }
  POINTREEL_INLINE void add(std::size_t expert, const Mask<8>& hit, const Float8& square_m2, float step_m) {
    constexpr float kRate = 1.F / 16, kMostSquaredSteps = 3;
    Float8& mean = mean_square_m2[expert];
    mean =
        mean + where(hit, kRate * (smaller(square_m2, all<8>(kMostSquaredSteps * step_m * step_m)) - mean));
  }
};

// Weights of the coded neighbours of a cell in the recent errors; 0 where there is none.
struct NeighbourWeights {
  Float8 left, left2, above, above_left, above_right, above2;
  Float8 total;

  POINTREEL_INLINE explicit NeighbourWeights(const Neighbourhood& cells)
      : left(where(seen(cells.range_m(-1)), all<8>(2))),
        left2(where(seen(cells.range_m(-2)), all<8>(0.7F))),
        above(where(seen(cells.range_m(0, -1)), all<8>(1))),
        above_left(where(seen(cells.range_m(-1, -1)), all<8>(1))),
        above_right(where(seen(cells.range_m(1, -1)), all<8>(1))),
        above2(where(seen(cells.range_m(0, -2)), all<8>(0.7F))),
        total(((left + left2) + (above + above2)) + (above_left + above_right)) {
    const Float8 per_total = where(all<8>(0.5F) <= total, all<8>(1) / larger(total, all<8>(0.5F)));
    for (Float8* weight : {&left, &left2, &above, &above_left, &above_right, &above2})
      *weight = *weight * per_total;
  }
};

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

// The blend of eight cells' proposals: their mean but for lane 0, weighted by the inverse fourth power of
// their recent errors.
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

// Replaces lane 0 of `proposals` by the blend. `precision`: of each proposal, 1 / its recent squared error.
template <std::size_t kExperts>
POINTREEL_INLINE Blend weigh(const ErrorPlanes<kExperts>& errors, const RowErrors<kExperts>& row_errors,
                             const Neighbourhood& cells, int step, float step_m,
                             Proposals<kExperts>& proposals, Float8 (&precision)[kExperts]) {
  constexpr float kRowShare = 0.5F;
  constexpr float kUnknownSquaredSteps = 30;  // the experts' error where no neighbour is known
  constexpr std::ptrdiff_t kPitch = ErrorPlanes<kExperts>::kPitch;
  const NeighbourWeights weights(cells);
  const float squared_step = step_m * step_m;
  const float floor = error_floor(step_m);
  const Mask<8> none = weights.total <= all<8>(0);
  const Float8 unknown = where(none, all<8>(kUnknownSquaredSteps * squared_step));
  const float* left = errors.at(step, -1);
  const float* left2 = errors.at(step, -2);
  const float* above = errors.at(step, 0, -1);
  const float* above_left = errors.at(step, -1, -1);
  const float* above_right = errors.at(step, 1, -1);
  const float* above2 = errors.at(step, 0, -2);
  Float8 weighted = all<8>(0), total = all<8>(0);
  Float8 weight[kExperts];
  Blend blend;
  for (std::size_t k = 0; k < kExperts; ++k) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) * kPitch;
    const Float8 in_row = load<8>(left + at) * weights.left + load<8>(left2 + at) * weights.left2;
    const Float8 in_column = load<8>(above + at) * weights.above + load<8>(above2 + at) * weights.above2;
    const Float8 across =
        load<8>(above_left + at) * weights.above_left + load<8>(above_right + at) * weights.above_right;
    const Float8 mean_square =
        (((in_row + in_column) + across) + unknown) + kRowShare * row_errors.mean_square_m2[k];
    precision[k] = all<8>(1) / (mean_square + all<8>(floor));
    if (k == 0) {
      blend.squared_error = (1 / squared_step) * mean_square;
    } else {
      weight[k] = precision[k] * precision[k];
      weighted = weighted + weight[k] * proposals.range_m[k];
      total = total + weight[k];
    }
  }
  blend.range_m = weighted / total;
  proposals.range_m[0] = blend.range_m;
  Float8 spread = all<8>(0);
  for (std::size_t k = 1; k < kExperts; ++k) {
    const Float8 away_m = proposals.range_m[k] - blend.range_m;
    spread = spread + weight[k] * (away_m * away_m);
  }
  blend.spread = (1 / squared_step) * (spread / total);
  return blend;
}

// The same with all that the mixture looks at, which is one of the first kMixed experts.
template <std::size_t kExperts, std::size_t kMixed>
HWY_NOINLINE void blend(const ErrorPlanes<kExperts>& errors, const RowErrors<kExperts>& row_errors,
                        const Neighbourhood& cells, int step, float step_m, Proposals<kExperts>& proposals,
                        BlendedProposals<kMixed>& blended) {
  Float8 precision[kExperts];
  const Blend blend = weigh<kExperts>(errors, row_errors, cells, step, step_m, proposals, precision);
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

// Squared errors of the proposals at what was decoded, for later cells. Where no expert was asked, those of a
// smooth surface.
template <std::size_t kExperts>
HWY_NOINLINE void remember_errors(const Proposals<kExperts>& proposals, const Float8& decoded_m,
                                  bool proposed, float step_m, int step, ErrorPlanes<kExperts>& errors,
                                  RowErrors<kExperts>& row_errors) {
  constexpr float kUnknownSquaredSteps = 0.1F;
  constexpr std::ptrdiff_t kPitch = ErrorPlanes<kExperts>::kPitch;
  float* to = errors.at(step);
  if (!proposed) {
    for (std::size_t k = 0; k < kExperts; ++k)
      store(all<8>(kUnknownSquaredSteps * step_m * step_m), to + static_cast<std::ptrdiff_t>(k) * kPitch);
    return;
  }
  const Mask<8> hit = seen(decoded_m);
  for (std::size_t k = 0; k < kExperts; ++k) {
    const Float8 error_m = proposals.range_m[k] - decoded_m;
    const Float8 square_m2 = error_m * error_m;
    row_errors.add(k, hit, square_m2, step_m);
    store(smaller(square_m2, all<8>(kLargestSquaredErrorM2)), to + static_cast<std::ptrdiff_t>(k) * kPitch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
