// POINTREEL_SIMD_LOOPS before a function: its loops, which compilers turn into SIMD code, exist for AVX2 as
// well, and the processor decides at start-up.
//
// For plain loops over points and cells. Elementwise float arithmetic gives the same bits at every width;
// what reorders sums or needs intrinsics goes through Highway (lanes-inl.h). Functions that it calls have to
// be inlined to gain from it. They are for their own file: compilers differ in what callers elsewhere have to
// know of them.
#pragma once

// None under the thread sanitizer, which has not started when the processor decides. (Eigen defines
// __has_feature for gcc, too.)
#if defined(__SANITIZE_THREAD__)
#define POINTREEL_SIMD_LOOPS
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define POINTREEL_SIMD_LOOPS
#endif
#endif

#ifndef POINTREEL_SIMD_LOOPS
#ifdef __x86_64__
#define POINTREEL_SIMD_LOOPS __attribute__((target_clones("avx2", "default")))
#else
#define POINTREEL_SIMD_LOOPS
#endif
#endif
