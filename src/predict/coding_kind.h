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

// Whether the experts are trusted by the circumstances of a cell (expert_trust.h).
constexpr bool has_trust(const CodingKind& kind) {
  return kind.predicted && kind.effort == Effort::max;
}

// Whether lines that follow the rows stand in for local fits, which take nearly as many instructions as
// all other prediction.
constexpr bool has_row_lines(const CodingKind& kind) {
  return kind.predicted && kind.effort == Effort::balanced;
}

// Experts that predict the ranges of such a frame; effort fast has others.
constexpr std::size_t experts_of(const CodingKind& kind) {
  return kind.effort == Effort::fast ? 0 : kind.predicted && !has_trust(kind) ? 12 : 16;
}
// The first of them are in the mixture: one SIMD register of experts takes half the time of two.
constexpr std::size_t mixed_of(const CodingKind& kind) {
  return kind.effort == Effort::fast ? 0 : kind.predicted && !has_trust(kind) ? 8 : 16;
}

}  // namespace pointreel
