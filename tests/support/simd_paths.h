// Runs code once for each instruction set that the library was compiled for and the processor has.
#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace pointreel {

// Calls run(name of the instruction set) with the library confined to it.
template <class Run>
void for_each_simd_path(const Run& run) {
#if defined(HWY_COMPILE_ONLY_STATIC) || defined(HWY_COMPILE_ONLY_SCALAR)
  run(hwy::TargetName(HWY_STATIC_TARGET));
#else
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    run(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
#endif
}

}  // namespace pointreel
