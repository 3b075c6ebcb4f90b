// Everything that the model of the hit mask learns while it codes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/bit_mixer.h"
#include "predict/coding_kind.h"
#include "predict/wavefront.h"

namespace pointreel {

struct HitMaskState {
  // kReference and kAgreement: predicted frames only.
  enum Context : std::uint8_t { kRange, kRuns, kRow, kEdges, kDensity, kReference, kAgreement, kContexts };
  static constexpr std::array<std::size_t, kContexts> kSlots = {768, 512, 8, 1024, 1024, 2048, 1024};
  static constexpr std::size_t kKeyContexts = kReference;
  static constexpr std::size_t kFastContexts = kRow;

  explicit HitMaskState(std::size_t rows) {
    for (std::size_t i = 0; i < kContexts; ++i)
      terms[i].resize(i == kRow ? std::max<std::size_t>(rows, 1) * kSlots[i] : kSlots[i]);
  }

  // Of the band: at least 1.
  std::size_t rows() const { return terms[kRow].size() / kSlots[kRow]; }

  // Of a number of cells amid hits: all are hits. (Efforts use those of some numbers only.)
  std::array<CountedBit, Wavefront::kRows + 1> together;

  std::array<CountedBit, kSlots[kEdges]> sure;      // of one cell amid hits
  std::array<std::vector<float>, kContexts> terms;  // of the others; kRow: kSlots for each row
};

// Shows a visitor all that adapts, in the order of the tables of priors (priors.h).
template <class State, class Visitor>
void visit_hit_mask_state(State& state, Visitor& visitor) {
  for (auto& bit : state.together) visitor.bit(bit);
  for (auto& bit : state.sure) visitor.bit(bit);
  for (std::size_t i = 0; i < HitMaskState::kContexts; ++i) {
    if (i == HitMaskState::kRow) {
      visitor.weights_by_row(state.terms[i].data(), state.rows(), HitMaskState::kSlots[HitMaskState::kRow]);
    } else {
      for (auto& term : state.terms[i]) visitor.weight(term);
    }
  }
}

}  // namespace pointreel
