// What surrounds a cell, as far as the coding of its bin looks: the steps coded at its neighbours.

#if defined(POINTREEL_PREDICT_STEP_CONTEXT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_STEP_CONTEXT_INL_H_
#undef POINTREEL_PREDICT_STEP_CONTEXT_INL_H_
#else
#define POINTREEL_PREDICT_STEP_CONTEXT_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstdint>

#include "predict/neighbourhood-inl.h"
#include "predict/range_state.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline constexpr std::int32_t kMostContextSteps = 2;

// Indices of adaptive models, for one cell.
struct StepContext {
  std::size_t signs;         // of the steps left, above and above right, 0 to 124
  std::size_t activity;      // 0 to 15: the sizes of the steps around; the nearest two count twice
  std::size_t availability;  // of returns left and above
  std::size_t row;
  std::size_t error;                                    // 0 to 15: the blend's recent error
  std::size_t spread;                                   // 0 to 15: how far the proposals lie apart
  std::array<std::size_t, StepModels::kPlaces> places;  // of two triples of proposals among the bins
};

// Of eight cells. `steps`: what was coded, clipped to +-kMostContextSteps; 0 where there is no return.
class StepContexts {
 public:
  StepContexts() = default;
  POINTREEL_INLINE StepContexts(const SkewedPlane<std::int32_t>& steps, const Neighbourhood& cells,
                                int step) {
    const auto at = [&](int columns_right, int rows_down)
                        HWY_ATTR { return load_ints<8>(steps.at(step, columns_right, rows_down)); };
    const Int8 left = at(-1, 0), left2 = at(-2, 0);
    const Int8 above = at(0, -1), above_left = at(-1, -1), above_right = at(1, -1);
    constexpr std::int32_t kMiddle = (kMostContextSteps * 5 + kMostContextSteps) * 5 + kMostContextSteps;
    store(times5(times5(left) + above) + above_right + all_ints<8>(kMiddle), signs_);
    const Int8 near = absolute(left) + absolute(above);
    const Int8 around = near + near + absolute(above_right) + absolute(left2) + absolute(above_left);
    store(smaller(around, all_ints<8>(static_cast<std::int32_t>(StepModels::kActivities) - 1)), activity_);
    const Int8 one = all_ints<8>(1);
    const Int8 has_left = where(as_int_mask(seen(cells.range_m(-1))), one);
    const Int8 has_above = where(as_int_mask(seen(cells.range_m(0, -1))), one);
    store(has_left + has_above + has_above, availability_);
  }

  // Where triples of proposals lie, in steps from the blend (lane 0), rounded, in seven places each.
  template <std::size_t kTriples>
  POINTREEL_INLINE void find_places(const Float8* range_m, float step_m,
                                    const std::array<std::array<std::uint8_t, 3>, kTriples>& triples) {
    for (std::size_t i = 0; i < kTriples; ++i) {
      Int8 places = all_ints<8>(0);
      for (const std::uint8_t expert : triples[i]) {
        const Float8 steps = (1 / step_m) * (range_m[expert] - range_m[0]);
        // Conversions truncate: halves round up where all is positive.
        places = (shifted_left<3>(places) - places) +
                 truncated(larger(smaller(steps, all<8>(3)), all<8>(-3)) + all<8>(3.5F));
      }
      store(places, places_[i]);
    }
  }

  POINTREEL_INLINE StepContext of(std::size_t cell, int row, std::int32_t error_class,
                                  std::int32_t spread_class) const {
    const auto sixteen = [](std::int32_t c) HWY_ATTR {
      constexpr auto kLast = static_cast<std::int32_t>(StepModels::kErrors) - 1;
      return static_cast<std::size_t>(std::clamp(c - 2, 0, kLast));
    };
    return {static_cast<std::size_t>(signs_[cell]),
            static_cast<std::size_t>(activity_[cell]),
            static_cast<std::size_t>(availability_[cell]),
            std::min(static_cast<std::size_t>(row), StepModels::kRows - 1),
            sixteen(error_class),
            sixteen(spread_class),
            {static_cast<std::size_t>(places_[0][cell]), static_cast<std::size_t>(places_[1][cell])}};
  }

 private:
  static POINTREEL_INLINE Int8 times5(const Int8& a) { return shifted_left<2>(a) + a; }

  alignas(32) std::int32_t signs_[8], activity_[8], availability_[8];
  alignas(32) std::int32_t places_[StepModels::kPlaces][8] = {};
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
