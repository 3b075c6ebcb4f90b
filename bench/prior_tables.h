// Tables of priors as C++ source, for the training programs.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "predict/hit_mask_priors.h"

namespace pointreel {

// The byte that bit_from_prior() reads. Priors count for half as many bits as training saw, at most.
inline int prior_byte(Probability16 p_one, std::uint32_t count) {
  int level = 0;
  for (int i = 1; i < 4; ++i) {
    if (count >= 2u * kPriorCounts[static_cast<std::size_t>(i)]) level = i;
  }
  const int step = std::clamp((stretch(p_one) + kMaxStretch) / kPriorStep, 0, 63);
  return (count == 0 ? 32 : step) << 2 | level;
}

template <std::size_t kInputs>
int prior_weight(const BitMixer<kInputs>& mixer, std::size_t input) {
  return mixer.weight(static_cast<int>(input)) / (BitMixer<kInputs>::kOne / 256);
}

inline void print_list(const std::vector<int>& values) {
  std::string line = "   ";
  for (const int value : values) {
    const std::string item = fmt::format(" {},", value);
    if (line.size() + item.size() > 110) {
      fmt::print("{}\n", line);
      line = "   ";
    }
    line += item;
  }
  fmt::print("{}\n", line);
}

}  // namespace pointreel
