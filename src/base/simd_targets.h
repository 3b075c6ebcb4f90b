// Which instruction sets Highway compiles for; included before hwy/foreach_target.h.
#pragma once

// SSE4, AVX2 and NEON carry their weight; AVX-512 is slower here, its wide divisions and square roots are.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
