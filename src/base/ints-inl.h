// Ints<N>: N 32-bit integers as one value, in the same lanes as Floats<N>, and IntMask<N>, which of them
// something holds for.

#if defined(POINTREEL_BASE_INTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_BASE_INTS_INL_H_
#undef POINTREEL_BASE_INTS_INL_H_
#else
#define POINTREEL_BASE_INTS_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <std::size_t N>
struct Ints {
  using Tag = hn::RebindToSigned<typename Floats<N>::Tag>;
  static constexpr std::size_t kPartLanes = Floats<N>::kPartLanes;
  static constexpr std::size_t kParts = Floats<N>::kParts;
  hn::Vec<Tag> part[kParts];

  POINTREEL_INLINE Ints() {}
};
template <std::size_t N>
struct IntMask {
  hn::Mask<typename Ints<N>::Tag> part[Floats<N>::kParts];

  POINTREEL_INLINE IntMask() {}
};
using Int8 = Ints<8>;

template <std::size_t N, class Operation>
POINTREEL_INLINE Ints<N> each_int(const Operation& operation) {
  Ints<N> result;
  for (std::size_t i = 0; i < Ints<N>::kParts; ++i) result.part[i] = operation(i);
  return result;
}
template <std::size_t N, class Operation>
POINTREEL_INLINE IntMask<N> each_int_mask(const Operation& operation) {
  IntMask<N> result;
  for (std::size_t i = 0; i < Ints<N>::kParts; ++i) result.part[i] = operation(i);
  return result;
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> load_ints(const std::int32_t* lanes) {
  using I = Ints<N>;
  return each_int<N>([&](std::size_t i)
                         HWY_ATTR { return hn::LoadU(typename I::Tag(), lanes + i * I::kPartLanes); });
}
template <std::size_t N>
POINTREEL_INLINE void store(const Ints<N>& a, std::int32_t* lanes) {
  using I = Ints<N>;
  for (std::size_t i = 0; i < I::kParts; ++i)
    hn::StoreU(a.part[i], typename I::Tag(), lanes + i * I::kPartLanes);
}
// The first `count` of them, as bytes.
template <std::size_t N>
POINTREEL_INLINE void store_first_bytes(const Ints<N>& a, std::uint8_t* bytes, std::size_t count) {
  using I = Ints<N>;
  const hn::Rebind<std::uint8_t, typename I::Tag> tag;
  std::uint8_t padded[N];
  std::uint8_t* to = count >= N ? bytes : padded;
  for (std::size_t i = 0; i < I::kParts; ++i)
    hn::StoreU(hn::DemoteTo(tag, a.part[i]), tag, to + i * I::kPartLanes);
  for (std::size_t i = 0; i < count && count < N; ++i) bytes[i] = padded[i];
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> all_ints(std::int32_t x) {
  return each_int<N>([&](std::size_t) HWY_ATTR { return hn::Set(typename Ints<N>::Tag(), x); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> operator+(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Add(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> operator-(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Sub(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> operator*(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Mul(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> operator|(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Or(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> operator&(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::And(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> absolute(const Ints<N>& a) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Abs(a.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> smaller(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Min(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> larger(const Ints<N>& a, const Ints<N>& b) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Max(a.part[i], b.part[i]); });
}
template <int kBits, std::size_t N>
POINTREEL_INLINE Ints<N> shifted_left(const Ints<N>& a) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::ShiftLeft<kBits>(a.part[i]); });
}
template <int kBits, std::size_t N>
POINTREEL_INLINE Ints<N> shifted_right(const Ints<N>& a) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::ShiftRight<kBits>(a.part[i]); });
}
// Each lane by bits of its own.
template <std::size_t N>
POINTREEL_INLINE Ints<N> operator>>(const Ints<N>& a, const Ints<N>& bits) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::Shr(a.part[i], bits.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE IntMask<N> operator>(const Ints<N>& a, const Ints<N>& b) {
  return each_int_mask<N>([&](std::size_t i) HWY_ATTR { return hn::Gt(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE IntMask<N> operator==(const Ints<N>& a, const Ints<N>& b) {
  return each_int_mask<N>([&](std::size_t i) HWY_ATTR { return hn::Eq(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE IntMask<N> operator|(const IntMask<N>& a, const IntMask<N>& b) {
  return each_int_mask<N>([&](std::size_t i) HWY_ATTR { return hn::Or(a.part[i], b.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> select(const IntMask<N>& mask, const Ints<N>& yes, const Ints<N>& no) {
  return each_int<N>([&](std::size_t i)
                         HWY_ATTR { return hn::IfThenElse(mask.part[i], yes.part[i], no.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> where(const IntMask<N>& mask, const Ints<N>& a) {  // 0 elsewhere
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::IfThenElseZero(mask.part[i], a.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> bits_of(const Floats<N>& a) {
  return each_int<N>([&](std::size_t i) HWY_ATTR { return hn::BitCast(typename Ints<N>::Tag(), a.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> as_floats(const Ints<N>& a) {
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::ConvertTo(typename Floats<N>::Tag(), a.part[i]); });
}
// Towards 0; beyond 32 bits processors disagree.
template <std::size_t N>
POINTREEL_INLINE Ints<N> truncated(const Floats<N>& a) {
  return each_int<N>([&](std::size_t i)
                         HWY_ATTR { return hn::ConvertTo(typename Ints<N>::Tag(), a.part[i]); });
}
// Elements of an array.
template <std::size_t N>
POINTREEL_INLINE Floats<N> gather(const float* values, const Ints<N>& index) {
  return each<N>([&](std::size_t i)
                     HWY_ATTR { return hn::GatherIndex(typename Floats<N>::Tag(), values, index.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Ints<N> gather(const std::int32_t* values, const Ints<N>& index) {
  return each_int<N>([&](std::size_t i) HWY_ATTR {
    return hn::GatherIndex(typename Ints<N>::Tag(), values, index.part[i]);
  });
}
template <std::size_t N>
POINTREEL_INLINE Mask<N> as_float_mask(const IntMask<N>& mask) {
  Mask<N> result;
  for (std::size_t i = 0; i < Floats<N>::kParts; ++i)
    result.part[i] = hn::RebindMask(typename Floats<N>::Tag(), mask.part[i]);
  return result;
}
template <std::size_t N>
POINTREEL_INLINE IntMask<N> as_int_mask(const Mask<N>& mask) {
  return each_int_mask<N>([&](std::size_t i)
                              HWY_ATTR { return hn::RebindMask(typename Ints<N>::Tag(), mask.part[i]); });
}

// Each lane moves up by one; the first becomes `first`.
template <std::size_t N>
POINTREEL_INLINE Ints<N> moved_up(const Ints<N>& a, std::int32_t first) {
  const typename Ints<N>::Tag tag;
  auto before = hn::Set(tag, first);
  return each_int<N>([&](std::size_t i) HWY_ATTR {
#if HWY_TARGET == HWY_SCALAR
    const auto moved = before;
#else
    if constexpr (Ints<N>::kPartLanes == 8) before = hn::ConcatLowerUpper(tag, a.part[i], before);
    const auto moved = hn::CombineShiftRightBytes<12>(tag, a.part[i], before);
#endif
    before = a.part[i];
    return moved;
  });
}
// Eight lanes of bits, the first in bit 0.
POINTREEL_INLINE Int8 bits_by_lane(std::uint32_t bits) {
  static constexpr std::int32_t kBits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  return where((all_ints<8>(static_cast<std::int32_t>(bits)) & load_ints<8>(kBits)) > all_ints<8>(0),
               all_ints<8>(1));
}
// Lanes as bits: the first of them, and the others.
POINTREEL_INLINE std::size_t first_lane(std::uint32_t bits) {
  return static_cast<std::size_t>(std::countr_zero(bits));
}
POINTREEL_INLINE std::uint32_t without_first_lane(std::uint32_t bits) {
  return bits & (bits - 1);
}
// The first eight lanes but one are false.
POINTREEL_INLINE IntMask<8> only_lane(std::size_t lane) {
  static constexpr std::int32_t kLanes[15] = {0, 0, 0, 0, 0, 0, 0, 1};
  return load_ints<8>(kLanes + 7 - lane) > all_ints<8>(0);
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
