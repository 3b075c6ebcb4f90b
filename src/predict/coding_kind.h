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

// Experts that predict the ranges of such a frame.
constexpr std::size_t experts_of(const CodingKind& kind) {
  if (kind.effort == Effort::fast) return 8;
  return kind.predicted && kind.effort == Effort::max ? 24 : 16;
}

}  // namespace pointreel
