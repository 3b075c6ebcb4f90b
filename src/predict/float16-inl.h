// Floats<N>: N floats as one value, in as few SIMD registers as the processor allows (at most 8 lanes each).
//
// Compiled once per instruction set by Highway (see band_coder.cpp). Every operation is IEEE, lane by lane,
// and sums have one fixed order, so that all instruction sets compute the same bits.

#if defined(POINTREEL_PREDICT_FLOAT16_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_FLOAT16_INL_H_
#undef POINTREEL_PREDICT_FLOAT16_INL_H_
#else
#define POINTREEL_PREDICT_FLOAT16_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// N floats in kParts registers.
template <std::size_t N>
struct Floats {
  using Tag = hn::CappedTag<float, N>;
  static constexpr std::size_t kPartLanes = hn::MaxLanes(Tag());
  static constexpr std::size_t kParts = N / kPartLanes;
  hn::Vec<Tag> part[kParts];

  HWY_INLINE Floats() {}  // gcc's own would not be compiled for the instruction set
};
template <std::size_t N>
struct Mask {
  hn::Mask<typename Floats<N>::Tag> part[Floats<N>::kParts];

  HWY_INLINE Mask() {}
};
using Float8 = Floats<8>;
using Float16 = Floats<16>;

template <std::size_t N, class Operation>
HWY_INLINE Floats<N> each(const Operation& operation) {
  Floats<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = operation(i);
  return result;
}

template <std::size_t N>
HWY_INLINE Floats<N> load(const float* lanes) {
  using F = Floats<N>;
  return each<N>([&](std::size_t i)
                     HWY_ATTR { return hn::LoadU(typename F::Tag(), lanes + i * F::kPartLanes); });
}
template <std::size_t N>
HWY_INLINE void store(const Floats<N>& a, float* lanes) {
  using F = Floats<N>;
  for (std::size_t i = 0; i < F::kParts; ++i)
    hn::StoreU(a.part[i], typename F::Tag(), lanes + i * F::kPartLanes);
}
template <std::size_t N>
HWY_INLINE Floats<N> all(float x) {
  return each<N>([&](std::size_t) HWY_ATTR { return hn::Set(typename Floats<N>::Tag(), x); });
}
template <std::size_t N>
HWY_INLINE Floats<N> operator+(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Add(a.part[i], b.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> operator-(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Sub(a.part[i], b.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> operator*(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Mul(a.part[i], b.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> operator*(float a, const Floats<N>& b) {
  return all<N>(a) * b;
}
template <std::size_t N>
HWY_INLINE Floats<N> operator/(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Div(a.part[i], b.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> square_root(const Floats<N>& a) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Sqrt(a.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> absolute(const Floats<N>& a) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Abs(a.part[i]); });
}
// Operands are never NaN here, so that all instruction sets agree.
template <std::size_t N>
HWY_INLINE Floats<N> smaller(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Min(a.part[i], b.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> larger(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Max(a.part[i], b.part[i]); });
}
template <std::size_t N>
HWY_INLINE Mask<N> operator<=(const Floats<N>& a, const Floats<N>& b) {
  Mask<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = hn::Le(a.part[i], b.part[i]);
  return result;
}
template <std::size_t N>
HWY_INLINE Mask<N> operator&(const Mask<N>& a, const Mask<N>& b) {
  Mask<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = hn::And(a.part[i], b.part[i]);
  return result;
}
template <std::size_t N>
HWY_INLINE Floats<N> select(const Mask<N>& mask, const Floats<N>& yes, const Floats<N>& no) {
  return each<N>([&](std::size_t i)
                     HWY_ATTR { return hn::IfThenElse(mask.part[i], yes.part[i], no.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> where(const Mask<N>& mask, const Floats<N>& a) {  // 0 elsewhere
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::IfThenElseZero(mask.part[i], a.part[i]); });
}
template <std::size_t N>
HWY_INLINE Floats<N> without_first(const Floats<N>& a) {  // lane 0 becomes 0
  Floats<N> result = a;
  result.part[0] = hn::IfThenZeroElse(hn::FirstN(typename Floats<N>::Tag(), 1), a.part[0]);
  return result;
}
// `a` with x in lane kLane. (Writing single lanes in memory and loading them as a vector stalls.)
template <std::size_t kLane, std::size_t N>
HWY_INLINE Floats<N> with_lane(const Floats<N>& a, float x) {
  using F = Floats<N>;
  const typename F::Tag tag;
  constexpr std::size_t kPart = kLane / F::kPartLanes, kIn = kLane % F::kPartLanes;
  Floats<N> result = a;
  const auto up_to = hn::FirstN(tag, kIn + 1);
  const auto before = hn::FirstN(tag, kIn);
  result.part[kPart] = hn::IfThenElse(hn::AndNot(before, up_to), hn::Set(tag, x), a.part[kPart]);
  return result;
}
template <std::size_t N>
HWY_INLINE float first(const Floats<N>& a) {
  return hn::GetLane(a.part[0]);
}

// Lane i with lane i + N/2, then i with i + N/4 and so on.
template <std::size_t N, class Operation>
HWY_INLINE float combine(const Floats<N>& a, const Operation& operation) {
  Floats<N> halved = a;
  for (std::size_t half = Floats<N>::kParts / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) halved.part[i] = operation(halved.part[i], halved.part[i + half]);
  }
#if HWY_TARGET == HWY_SCALAR
  return hn::GetLane(halved.part[0]);
#else
#if HWY_MAX_BYTES >= 32
  const hn::Full128<float> quad;
  const auto four = operation(hn::LowerHalf(quad, halved.part[0]), hn::UpperHalf(quad, halved.part[0]));
#else
  const auto four = halved.part[0];
#endif
  const auto two = operation(four, hn::Shuffle1032(four));
  return hn::GetLane(operation(two, hn::Shuffle2301(two)));
#endif
}
// Float addition is not associative: combine's order is part of the format.
template <std::size_t N>
HWY_INLINE float sum(const Floats<N>& a) {
  return combine(a, [](auto x, auto y) HWY_ATTR { return hn::Add(x, y); });
}
}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
