// Across the lanes of Floats<N>: sums and the like, each in one fixed order, and rows of lanes turned into
// columns.

#if defined(POINTREEL_BASE_ACROSS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_BASE_ACROSS_LANES_INL_H_
#undef POINTREEL_BASE_ACROSS_LANES_INL_H_
#else
#define POINTREEL_BASE_ACROSS_LANES_INL_H_
#endif

#include <cstddef>

#include "base/floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Groups of eight lanes one after the other, then lane i with i + 4, with i + 2 and with i + 1.
template <std::size_t N, class Operation>
POINTREEL_INLINE float combine(const Floats<N>& a, const Operation& operation) {
  using F = Floats<N>;
  constexpr std::size_t kGroup = N < 8 ? N : 8;
  constexpr std::size_t kGroupParts = kGroup / F::kPartLanes;
  Floats<kGroup> eight;
  for (std::size_t i = 0; i < kGroupParts; ++i) {
    eight.part[i] = a.part[i];
    for (std::size_t g = 1; g < N / kGroup; ++g)
      eight.part[i] = operation(eight.part[i], a.part[g * kGroupParts + i]);
  }
  for (std::size_t half = kGroupParts / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) eight.part[i] = operation(eight.part[i], eight.part[i + half]);
  }
#if HWY_TARGET == HWY_SCALAR
  return hn::GetLane(eight.part[0]);
#else
  const hn::Full128<float> quad;
  hn::Vec<decltype(quad)> four;
#if HWY_MAX_BYTES >= 32
  if constexpr (F::kPartLanes == 8) {
    four = operation(hn::LowerHalf(quad, eight.part[0]), hn::UpperHalf(quad, eight.part[0]));
  } else {
    four = eight.part[0];
  }
#else
  four = eight.part[0];
#endif
  const auto two = operation(four, hn::Shuffle1032(four));
  return hn::GetLane(operation(two, hn::Shuffle2301(two)));
#endif
}
// Float addition is not associative: combine's order is part of the format.
template <std::size_t N>
POINTREEL_INLINE float sum(const Floats<N>& a) {
  return combine(a, [](auto x, auto y) HWY_ATTR { return hn::Add(x, y); });
}
template <std::size_t N>
POINTREEL_INLINE float largest(const Floats<N>& a) {
  return combine(a, [](auto x, auto y) HWY_ATTR { return hn::Max(x, y); });
}
template <std::size_t N>
POINTREEL_INLINE float smallest(const Floats<N>& a) {
  return combine(a, [](auto x, auto y) HWY_ATTR { return hn::Min(x, y); });
}
// The first lane that equals x, which one does.
template <std::size_t N>
POINTREEL_INLINE std::size_t first_lane_with(const Floats<N>& a, float x) {
  const typename Floats<N>::Tag tag;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) {
    const auto lane = hn::FindFirstTrue(tag, hn::Eq(a.part[i], hn::Set(tag, x)));
    if (lane >= 0) return i * Floats<N>::kPartLanes + static_cast<std::size_t>(lane);
  }
  return 0;
}

// Turns kGroups * 4 rows of 8 lanes into 8 rows of kGroups * 4 lanes: store_turned() takes four of the rows
// at a time, load_turned() gives one lane's.
template <std::size_t kGroups>
struct TurnedLanes {
  alignas(64) float lanes[kGroups][8][4];
};
template <std::size_t kGroups>
POINTREEL_INLINE void store_turned(const Float8& a, const Float8& b, const Float8& c, const Float8& d,
                                   std::size_t group, TurnedLanes<kGroups>& turned) {
  const Float8::Tag tag;
  for (std::size_t i = 0; i < Float8::kParts; ++i) {
#if HWY_TARGET == HWY_SCALAR
    float* lanes = turned.lanes[group][i];
    hn::Store(a.part[i], tag, lanes);
    hn::Store(b.part[i], tag, lanes + 1);
    hn::Store(c.part[i], tag, lanes + 2);
    hn::Store(d.part[i], tag, lanes + 3);
#else
    hn::StoreInterleaved4(a.part[i], b.part[i], c.part[i], d.part[i], tag,
                          &turned.lanes[group][i * Float8::kPartLanes][0]);
#endif
  }
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> load_turned(const TurnedLanes<N / 4>& turned, std::size_t lane) {
  using F = Floats<N>;
  return each<N>([&](std::size_t i) HWY_ATTR {
#if HWY_TARGET == HWY_SCALAR
    return hn::Load(typename F::Tag(), &turned.lanes[i / 4][lane][i % 4]);
#elif HWY_MAX_BYTES >= 32
    const hn::Full128<float> quad;
    return hn::Combine(typename F::Tag(), hn::Load(quad, turned.lanes[2 * i + 1][lane]),
                       hn::Load(quad, turned.lanes[2 * i][lane]));
#else
    return hn::Load(typename F::Tag(), turned.lanes[i][lane]);
#endif
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
