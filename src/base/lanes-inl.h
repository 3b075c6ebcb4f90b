// Floats<N>, Ints<N>: N numbers as one value, in as few SIMD registers as the processor allows (at most 8
// lanes each).
//
// Compiled once per instruction set by Highway (see band_coding.cpp). Every operation is IEEE, lane by lane,
// and sums have one fixed order, so that all instruction sets compute the same bits.

#if defined(POINTREEL_BASE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_BASE_LANES_INL_H_
#undef POINTREEL_BASE_LANES_INL_H_
#else
#define POINTREEL_BASE_LANES_INL_H_
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
// 32-bit integers, in the same lanes as the floats.
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
using Float8 = Floats<8>;
using Int8 = Ints<8>;

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
template <std::size_t N>
POINTREEL_INLINE Floats<N> select(const Mask<N>& mask, const Floats<N>& yes, const Floats<N>& no) {
  return each<N>([&](std::size_t i)
                     HWY_ATTR { return hn::IfThenElse(mask.part[i], yes.part[i], no.part[i]); });
}
template <std::size_t N>
POINTREEL_INLINE Floats<N> where(const Mask<N>& mask, const Floats<N>& a) {  // 0 elsewhere
  return each<N>([&](std::size_t i) HWY_ATTR { return hn::IfThenElseZero(mask.part[i], a.part[i]); });
}

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

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
