// Floats<N>: N floats as one value, in as few SIMD registers as the processor allows (at most 8 lanes each),
// and Mask<N>, which of them something holds for.

#if defined(POINTREEL_BASE_FLOATS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_BASE_FLOATS_INL_H_
#undef POINTREEL_BASE_FLOATS_INL_H_
#else
#define POINTREEL_BASE_FLOATS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"

// Without SIMD a value is many variables: forcing them through every call would take the compiler minutes.
#undef POINTREEL_INLINE
#if HWY_TARGET == HWY_SCALAR
#define POINTREEL_INLINE inline
#else
#define POINTREEL_INLINE HWY_INLINE
#endif

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// N floats in kParts registers.
template <std::size_t N>
struct Floats {
  using Tag = hn::CappedTag<float, (N < 8 ? N : 8)>;
  static constexpr std::size_t kPartLanes = hn::MaxLanes(Tag());
  static constexpr std::size_t kParts = N / kPartLanes;
  hn::Vec<Tag> part[kParts];

  POINTREEL_INLINE Floats() {}  // gcc's own would not be compiled for the instruction set
};
template <std::size_t N>
struct Mask {
  hn::Mask<typename Floats<N>::Tag> part[Floats<N>::kParts];

  POINTREEL_INLINE Mask() {}
};
using Float8 = Floats<8>;

template <std::size_t N, class Operation>
POINTREEL_INLINE Floats<N> each(const Operation& operation) {
  Floats<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = operation(i);
  return result;
}

template <std::size_t N>
POINTREEL_INLINE Floats<N> load(const float* lanes) {
  using F = Floats<N>;
  return each<N>([&](std::size_t i)
                     HWY_ATTR { return hn::LoadU(typename F::Tag(), lanes + i * F::kPartLanes); });
}
// The first `count` of them, then zeros.
template <std::size_t N>
POINTREEL_INLINE Floats<N> load_first(const float* lanes, std::size_t count) {
  if (count >= N) return load<N>(lanes);
  float padded[N] = {};
  for (std::size_t i = 0; i < count; ++i) padded[i] = lanes[i];
  return load<N>(padded);
}
template <std::size_t N>
POINTREEL_INLINE void store(const Floats<N>& a, float* lanes) {
  using F = Floats<N>;
  for (std::size_t i = 0; i < F::kParts; ++i)
    hn::StoreU(a.part[i], typename F::Tag(), lanes + i * F::kPartLanes);
}
// The first `count` of them.
template <std::size_t N>
POINTREEL_INLINE void store_first(const Floats<N>& a, float* lanes, std::size_t count) {
  if (count >= N) return store(a, lanes);
  float padded[N];
  store(a, padded);
  for (std::size_t i = 0; i < count; ++i) lanes[i] = padded[i];
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> all(float x) {
  return each<N>([&](std::size_t) HWY_ATTR { return hn::Set(typename Floats<N>::Tag(), x); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> operator+(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Add(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> operator-(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Sub(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> operator*(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Mul(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> operator*(float a, const Floats<N>& b) {
  return all<N>(a) * b;
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> operator/(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Div(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> square_root(const Floats<N>& a) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Sqrt(a.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> absolute(const Floats<N>& a) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Abs(a.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> with_sign_of(const Floats<N>& sign, const Floats<N>& magnitude) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::CopySign(magnitude.part[i], sign.part[i]); });
}
// Operands are never NaN here, so that all instruction sets agree.
template <std::size_t N>
POINTREEL_INLINE Floats<N> smaller(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Min(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> larger(const Floats<N>& a, const Floats<N>& b) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::Max(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Mask<N> operator<=(const Floats<N>& a, const Floats<N>& b) {
  Mask<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = hn::Le(a.part[i], b.part[i]);
  return result;
}
template <std::size_t N>
POINTREEL_INLINE Mask<N> operator<(const Floats<N>& a, const Floats<N>& b) {
  Mask<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = hn::Lt(a.part[i], b.part[i]);
  return result;
}
template <std::size_t N>
POINTREEL_INLINE Mask<N> operator&(const Mask<N>& a, const Mask<N>& b) {
  Mask<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i) result.part[i] = hn::And(a.part[i], b.part[i]);
  return result;
}
template <std::size_t N>
POINTREEL_INLINE bool any(const Mask<N>& mask) {
  bool none = true;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i)
    none = none && hn::AllFalse(typename Floats<N>::Tag(), mask.part[i]);
  return !none;
}
// A bit a lane, the first in bit 0.
POINTREEL_INLINE std::uint32_t lane_bits(const Mask<8>& mask) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < Float8::kParts; ++i) {
    std::uint8_t of_part[8] = {};
    hn::StoreMaskBits(Float8::Tag(), mask.part[i], of_part);
    bits |= std::uint32_t{of_part[0]} << (i * Float8::kPartLanes);
  }
  return bits;
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> select(const Mask<N>& mask, const Floats<N>& yes, const Floats<N>& no) {
  return each<N>([&](std::size_t i)
                     HWY_ATTR { return hn::IfThenElse(mask.part[i], yes.part[i], no.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> where(const Mask<N>& mask, const Floats<N>& a) {  // 0 elsewhere
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::IfThenElseZero(mask.part[i], a.part[i]); });
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
