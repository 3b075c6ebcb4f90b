// Where else than at the blend a range may lie, for effort fast: the other surfaces that are seen around a
// cell.

#if defined(POINTREEL_PREDICT_ALTERNATIVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_ALTERNATIVES_INL_H_
#undef POINTREEL_PREDICT_ALTERNATIVES_INL_H_
#else
#define POINTREEL_PREDICT_ALTERNATIVES_INL_H_
#endif

#include "predict/experts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Two of the surfaces seen around each of eight cells that are not the blend's; as a rule not each other's.
struct Alternatives {
  static constexpr std::size_t kMost = 2;
  enum Kind : std::uint8_t { kNone, kAtStart, kFromAbove, kFromAboveRight, kOther };

  alignas(32) float range_m[kMost][8];  // 0: none
  alignas(32) std::int32_t kind[kMost][8];

  POINTREEL_INLINE Alternatives() {}

  POINTREEL_INLINE void find(const RowMemory& memory, const Surroundings& around, const Float8& blend_m,
                             const Float8& apart_m) {
    Float8 first_m = all<8>(0), second_m = all<8>(0);
    Int8 first_kind = all_ints<8>(kNone), second_kind = all_ints<8>(kNone);
    // From the last to the first. One that is not another than the first before it takes its place.
    const auto look_at = [&](const Float8& seen_m, Kind its_kind) HWY_ATTR {
      const Mask<8> another = seen(seen_m) & (apart_m < absolute(seen_m - blend_m));
      const Mask<8> before_first = another & (apart_m < absolute(seen_m - first_m));
      second_m = select(before_first, first_m, second_m);
      second_kind = select(as_int_mask(before_first), first_kind, second_kind);
      first_m = select(another, seen_m, first_m);
      first_kind = select(as_int_mask(another), all_ints<8>(its_kind), first_kind);
    };
    look_at(memory.edge_m(), kOther);
    look_at(around.above_right2, kOther);
    look_at(around.above_right, kFromAboveRight);
    look_at(around.above, kFromAbove);
    look_at(around.start, kAtStart);
    store(first_m, range_m[0]);
    store(first_kind, kind[0]);
    store(second_m, range_m[1]);
    store(second_kind, kind[1]);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
