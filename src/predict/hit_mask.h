// Which cells of the sensor grid hold a return: one bit per cell, coded in raster order between the ranges.
//
// When a cell's bit is coded both sides know the hits and the decoded ranges of all cells before it, and all
// of the reference sweep. Six adaptive bits, each in a context of its own, predict it, and a mixer weighs
// them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/bit_mixer.h"

namespace pointreel {

// What a reference sweep says of a cell, one bit each.
enum HitReference : std::uint8_t {
  kWarpedHit = 1,     // the warped reference has a return here
  kWarpedFilled = 2,  // a hole of the warped reference, filled from its neighbours; not with kWarpedHit
  kPreviousHit = 4,   // the reference had a return in this cell, not warped: the car's own shadow stays
};

// The cells that share contexts and adaptive state: a band of rows of a cyclic image.
struct HitMaskBand {
  int first_row = 0;
  int rows = 0;
  int columns = 0;
  int image_rows = 0;  // of all bands
};

// Everything that adapts.
struct HitMaskState {
  enum Context { kRange, kRuns, kRow, kEdges, kDensity, kReference, kContexts };
  static constexpr std::array<int, kContexts> kSlots = {768, 512, 8, 1024, 1024, 2048};  // kRow: per row
  static constexpr int kMixers = 64;
  using Mixer = BitMixer<kContexts>;

  // As trained offline by bench/train_hit_mask.
  static HitMaskState from_priors(int rows);

  std::array<std::vector<CountedBit>, kContexts> bits;
  std::array<Mixer, kMixers> mixers;
};

// Columns are cyclic; rows of other bands are unseen. Per row: begin_row(), then for each column code(),
// followed by set_range() if it was a hit.
class HitMaskModel {
 public:
  // `reference`: HitReference bits of the band's cells, row-major, or empty; it must outlive the model.
  HitMaskModel(const HitMaskBand& band, std::span<const std::uint8_t> reference, HitMaskState state);

  void begin_row();

  // The next cell's bit; a decoder passes anything and gets it.
  template <class Coder>
  bool code(Coder& coder, bool hit) {
    const Probability16 p_one = predict();
    hit = coder.code_with(hit, p_one);
    learn(hit, p_one);
    return hit;
  }

  // The decoded range of the cell just coded, which was a hit.
  void set_range(float range_m);

  const HitMaskState& state() const { return state_; }

 private:
  using LogRange = std::uint16_t;  // 2048 per octave (linear within), 0 = no return

  // A row above, by column; hits are padded on both sides so that windows need not wrap.
  struct Row {
    std::vector<std::uint8_t> hits;
    std::vector<LogRange> ranges;
    std::vector<std::uint8_t> edges;  // class of the step to the next column
  };

  Probability16 predict();
  void learn(bool hit, Probability16 p_one);
  void finish_row();
  void know_hits_above();
  void know_density();
  void know_reference();

  HitMaskBand band_;
  std::span<const std::uint8_t> reference_;
  HitMaskState state_;

  Row current_, above_, above2_;
  std::vector<LogRange> column_range_;        // of the last hit in the column
  std::vector<std::uint8_t> column_history_;  // hits of the eight cells above, the nearest in bit 0

  // The parts of the contexts that the rows above and the reference give, by column.
  std::array<std::vector<std::uint16_t>, HitMaskState::kContexts> known_;
  std::vector<std::uint8_t> known_mixer_;

  std::uint32_t row_hits_ = 0;  // this row's hits so far, the last one in bit 0
  std::uint32_t run_ = 0;       // cells equal to the last one
  LogRange row_range_ = 0;      // of the last hit in the row
  int row_ = -1;
  int column_ = 0;

  std::array<CountedBit*, HitMaskState::kContexts> slots_{};
  HitMaskState::Mixer::Inputs inputs_{};
  HitMaskState::Mixer* mixer_ = nullptr;
};

}  // namespace pointreel
