// Looks for what hardly any element has.
#pragma once

#include <algorithm>
#include <cstddef>

namespace pointreel {

// The first of [from, end) for which `holds` is 1, not 0; `end` if there is none. Blocks are looked at as a
// whole, which becomes SIMD code.
template <class Holds>
std::size_t first_where(std::size_t from, std::size_t end, const Holds& holds) {
  constexpr std::size_t kBlock = 64;
  std::size_t k = from;
  for (; k + kBlock <= end; k += kBlock) {
    int any = 0;
    for (std::size_t i = k; i < k + kBlock; ++i) any |= holds(i);
    if (any != 0) break;
  }
  while (k < end && holds(k) == 0) ++k;
  return std::min(k, end);
}

// Calls act(i) for each of [0, end) for which `holds` is 1.
template <class Holds, class Act>
void for_each_where(std::size_t end, const Holds& holds, const Act& act) {
  for (std::size_t i = first_where(0, end, holds); i < end; i = first_where(i + 1, end, holds)) act(i);
}

}  // namespace pointreel
