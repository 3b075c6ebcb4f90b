// CodingKind: which of the format's models code a frame.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pointreel/codec.h"

namespace pointreel {

struct CodingKind {
  bool predicted = false;  // there is a reference image
  Effort effort = Effort::balanced;
};

// Experts of the mixture that predicts the ranges of such a frame; effort fast has none.
constexpr std::size_t experts_of(const CodingKind& kind) {
  if (kind.effort == Effort::fast) return 0;
  return kind.predicted && kind.effort == Effort::max ? 24 : 16;
}

}  // namespace pointreel
