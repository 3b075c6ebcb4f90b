// Floats<N>, Ints<N>: N numbers as one value, and what is computed with them.
//
// Compiled once per instruction set by Highway (base/simd_targets.h). Every operation is IEEE, lane by lane,
// and sums have one fixed order, so that all instruction sets compute the same bits.

#if defined(POINTREEL_BASE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_BASE_LANES_INL_H_
#undef POINTREEL_BASE_LANES_INL_H_
#else
#define POINTREEL_BASE_LANES_INL_H_
#endif

#include "base/across_lanes-inl.h"
#include "base/floats-inl.h"
#include "base/ints-inl.h"

#endif  // per target
