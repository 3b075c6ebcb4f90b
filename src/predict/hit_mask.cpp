#include "predict/hit_mask.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>

#include "predict/hit_mask_priors.h"

namespace pointreel {
namespace {

constexpr int kAhead = 8;
constexpr int kPadding = kAhead + 1;

constexpr int kWarped = kWarpedHit | kWarpedFilled;

// Steps between log ranges, and their classes.
constexpr int kSameSurface = 30;      // 1 to 1.5 %
constexpr int kSlantedSurface = 115;  // 4 to 6 %
constexpr int kNearby = 60;
constexpr int kFarApart = 775;  // a factor of 1.3

// Class of the step between two ranges: 0 unknown, 1 same surface, 2 slanted, 3 an edge.
std::uint8_t edge_class(int a, int b) {
  const int step = std::abs(a - b);
  const int known = 1 + (step >= kSameSurface ? 1 : 0) + (step >= kSlantedSurface ? 1 : 0);
  return static_cast<std::uint8_t>(a == 0 || b == 0 ? 0 : known);
}

// How the last range above lies to the last one in the row: 0 near, 1 behind, 2 far behind, 3 before, 4 far
// before, 5 unknown.
std::uint32_t order_class(int above, int row) {
  if (above == 0 || row == 0) return 5;
  const int step = above - row;
  if (std::abs(step) < kNearby) return 0;
  return (step > 0 ? 1u : 3u) + (std::abs(step) > kFarApart ? 1u : 0u);
}

// Two classes per octave from 1 m on.
std::uint32_t range_class(std::uint32_t log_range) {
  return static_cast<std::uint32_t>(std::clamp((static_cast<int>(log_range) >> 10) - 8, 0, 15));
}

std::uint32_t run_class(std::uint32_t run) {
  if (run < 4) return run;
  return run < 6 ? 4 : run < 10 ? 5 : run < 18 ? 6 : 7;
}

// Share of hits among kCells cells in eight classes; the last one is for all of them.
template <int kCells>
constexpr std::uint8_t share_class(int hits) {
  return static_cast<std::uint8_t>(hits == kCells ? 7 : std::min(6, hits * 7 / kCells));
}

// By the column's last eight cells.
constexpr auto kColumnShares = [] {
  std::array<std::uint8_t, 256> classes{};
  for (unsigned pattern = 0; pattern < 256; ++pattern)
    classes[pattern] = share_class<8>(std::popcount(pattern));
  return classes;
}();

// By the number of hits in the windows above.
constexpr auto kWindowShares = [] {
  constexpr int kCells = 2 * (2 * kAhead + 1);
  std::array<std::uint8_t, kCells + 1> classes{};
  for (int hits = 0; hits <= kCells; ++hits)
    classes[static_cast<std::size_t>(hits)] = share_class<kCells>(hits);
  return classes;
}();

// Share of hits among the last four cells, by their pattern: 0 none, 3 all.
constexpr auto kRowShares = [] {
  std::array<std::uint8_t, 16> classes{};
  for (unsigned pattern = 0; pattern < 16; ++pattern) {
    const int hits = std::popcount(pattern);
    classes[pattern] = static_cast<std::uint8_t>(hits == 4 ? 3 : hits == 0 ? 0 : hits > 2 ? 2 : 1);
  }
  return classes;
}();

// The float's exponent and 11 bits of its mantissa, 1 at 2^-4 m; what is nearer or beyond 2^12 m is clamped.
std::uint16_t log_range(float range_m) {
  constexpr std::int32_t kLowest = (127 - 4) << 11;
  const std::int32_t code = (std::bit_cast<std::int32_t>(range_m) >> 12) - kLowest;
  return static_cast<std::uint16_t>(std::clamp(code, 1, 0x7FFF));
}

}  // namespace

HitMaskState HitMaskState::from_priors(int rows) {
  HitMaskState state;
  const std::uint8_t* prior = kHitMaskPriors.data();
  for (std::size_t context = 0; context < kContexts; ++context) {
    auto& bits = state.bits[context];
    for (int slot = 0; slot < kSlots[context]; ++slot) bits.push_back(bit_from_prior(*prior++));
  }
  auto& row_bits = state.bits[kRow];
  const std::vector<CountedBit> one_row = row_bits;
  row_bits.reserve(one_row.size() * static_cast<std::size_t>(rows));
  for (int row = 1; row < rows; ++row) row_bits.insert(row_bits.end(), one_row.begin(), one_row.end());

  const std::int16_t* weight = kHitMaskWeights.data();
  for (Mixer& mixer : state.mixers) {
    for (int input = 0; input < kContexts; ++input) mixer.set_weight(input, *weight++ * (Mixer::kOne / 256));
  }
  return state;
}

HitMaskModel::HitMaskModel(const HitMaskBand& band, std::span<const std::uint8_t> reference,
                           HitMaskState state)
    : band_(band), reference_(reference), state_(std::move(state)) {
  const auto columns = static_cast<std::size_t>(band_.columns);
  // Nothing is known above the band: hits are the better guess than misses.
  for (Row* row : {&current_, &above_, &above2_}) {
    row->hits.assign(columns + 2 * kPadding, 1);
    row->ranges.assign(columns, 0);
    row->edges.assign(columns, 0);
  }
  for (auto& known : known_) known.assign(columns, 0);
  known_mixer_.assign(columns, 0);
  column_range_.assign(columns, 0);
  column_history_.assign(columns, 0xFF);
}

void HitMaskModel::begin_row() {
  if (row_ >= 0) finish_row();
  ++row_;
  column_ = 0;
  // The row's last cells, left of column 0 on the cylinder, are not known yet: take those above.
  row_hits_ = 0;
  for (std::size_t i = 0; i < kPadding; ++i) row_hits_ = row_hits_ << 1 | above_.hits[i];
  run_ = 1;
  row_range_ = 0;
  know_hits_above();
  know_density();
  if (!reference_.empty()) know_reference();
}

void HitMaskModel::know_hits_above() {
  const auto columns = static_cast<std::size_t>(band_.columns);
  const std::uint8_t* above = above_.hits.data() + kPadding;
  const std::uint8_t* above2 = above2_.hits.data() + kPadding;
  const int row = row_ << 3;
  for (std::size_t c = 0; c < columns; ++c)
    known_[HitMaskState::kRow][c] = static_cast<std::uint16_t>(row | above[c] << 1 | above2[c] << 2);
  for (std::size_t c = 0; c < columns; ++c) {
    known_[HitMaskState::kRuns][c] = static_cast<std::uint16_t>(
        above[c - 1] << 8 | above[c] << 7 | above[c + 1] << 6 | above[c + 2] << 5 | above[c + 3] << 4);
  }
  const int mixers = reference_.empty() ? 0 : 32;
  for (std::size_t c = 0; c < columns; ++c) {
    known_mixer_[c] =
        static_cast<std::uint8_t>(mixers | above[c] << 1 | above[c + 1] << 2 | above[c - 1] << 4);
  }
  int edge_before = above2_.edges[columns - 1];
  for (std::size_t c = 0; c < columns; ++c) {
    known_[HitMaskState::kEdges][c] = static_cast<std::uint16_t>(above[c] << 1 | above2_.edges[c] << 2 |
                                                                 edge_before << 4 | above_.edges[c] << 8);
    edge_before = above2_.edges[c];
  }
}

void HitMaskModel::know_density() {
  const auto columns = static_cast<std::size_t>(band_.columns);
  const std::uint8_t* above = above_.hits.data() + kPadding;
  const std::uint8_t* above2 = above2_.hits.data() + kPadding;
  int hits = 0;  // within kAhead columns in both rows
  for (int i = -kPadding; i < kAhead; ++i) hits += above[i] + above2[i];
  for (std::size_t c = 0; c < columns; ++c) {
    hits += above[c + kAhead] + above2[c + kAhead];
    hits -= above[c - kPadding] + above2[c - kPadding];
    known_[HitMaskState::kDensity][c] = static_cast<std::uint16_t>(
        kColumnShares[column_history_[c]] | kWindowShares[static_cast<std::size_t>(hits)] << 3 |
        above[c] << 8 | above[c + 1] << 9);
  }
}

void HitMaskModel::know_reference() {
  const auto columns = static_cast<std::size_t>(band_.columns);
  const std::uint8_t* cells = reference_.data() + static_cast<std::size_t>(row_) * columns;
  const std::uint8_t* above = above_.hits.data() + kPadding;
  const int quarter = ((band_.first_row + row_) * 4 / std::max(1, band_.image_rows)) & 3;
  int west = cells[columns - 1];
  for (std::size_t c = 0; c < columns; ++c) {
    const int east = cells[c + 1 < columns ? c + 1 : 0];
    known_[HitMaskState::kReference][c] = static_cast<std::uint16_t>(
        (cells[c] & 7) | (west & kPreviousHit) << 1 | (east & kPreviousHit) << 2 | above[c] << 6 |
        ((west & kWarped) != 0 ? 1 : 0) << 7 | ((east & kWarped) != 0 ? 1 : 0) << 8 | quarter << 9);
    west = cells[c];
  }
}

void HitMaskModel::finish_row() {
  const auto columns = static_cast<std::size_t>(band_.columns);
  for (std::size_t i = 0; i < kPadding; ++i) {
    current_.hits[i] = current_.hits[kPadding + (columns * kPadding + i - kPadding) % columns];
    current_.hits[kPadding + columns + i] = current_.hits[kPadding + i % columns];
  }
  for (std::size_t c = 0; c + 1 < columns; ++c)
    current_.edges[c] = edge_class(current_.ranges[c], current_.ranges[c + 1]);
  current_.edges[columns - 1] = edge_class(current_.ranges[columns - 1], current_.ranges[0]);
  std::swap(above2_, above_);
  std::swap(above_, current_);
}

Probability16 HitMaskModel::predict() {
  const auto c = static_cast<std::size_t>(column_);
  const std::size_t before = c > 0 ? c - 1 : static_cast<std::size_t>(band_.columns) - 1;
  const std::uint32_t west = row_hits_ & 1;
  const LogRange range_above = column_range_[c];

  // What is known of the rows above, and on top of it what the row itself adds.
  std::array<std::uint32_t, HitMaskState::kContexts> context;
  for (std::size_t i = HitMaskState::kRuns; i < HitMaskState::kContexts; ++i) context[i] = known_[i][c];
  context[HitMaskState::kRange] = (context[HitMaskState::kRow] & 6) | west |
                                  range_class(row_range_ != 0 ? row_range_ : range_above) << 3 |
                                  order_class(range_above, row_range_) << 7;
  context[HitMaskState::kRuns] |= run_class(run_) | west << 3;
  context[HitMaskState::kRow] |= west;
  context[HitMaskState::kEdges] |=
      west | static_cast<std::uint32_t>(edge_class(row_range_, above2_.ranges[before])) << 6;
  context[HitMaskState::kDensity] |= static_cast<std::uint32_t>(kRowShares[row_hits_ & 15]) << 6;
  context[HitMaskState::kReference] |= west << 5;

  for (std::size_t i = 0; i < HitMaskState::kContexts; ++i) {
    slots_[i] = &state_.bits[i][context[i]];
    inputs_[i] = slots_[i]->stretch();
  }
  if (reference_.empty()) inputs_[HitMaskState::kReference] = 0;
  mixer_ = &state_.mixers[known_mixer_[c] | west | (row_hits_ & 2) << 2];
  return mixer_->p_one(inputs_);
}

void HitMaskModel::learn(bool hit, Probability16 p_one) {
  mixer_->update(inputs_, p_one, hit);
  for (std::size_t i = 0; i < HitMaskState::kReference; ++i) slots_[i]->update(hit);
  if (!reference_.empty()) slots_[HitMaskState::kReference]->update(hit);

  const auto c = static_cast<std::size_t>(column_);
  const std::uint32_t bit = hit ? 1 : 0;
  run_ = (row_hits_ & 1) == bit ? run_ + 1 : 1;
  row_hits_ = row_hits_ << 1 | bit;
  column_history_[c] = static_cast<std::uint8_t>(column_history_[c] << 1 | (hit ? 1 : 0));
  current_.hits[kPadding + c] = static_cast<std::uint8_t>(bit);
  current_.ranges[c] = 0;
  ++column_;
}

void HitMaskModel::set_range(float range_m) {
  const auto c = static_cast<std::size_t>(column_ - 1);
  row_range_ = log_range(range_m);
  current_.ranges[c] = row_range_;
  column_range_[c] = row_range_;
}

}  // namespace pointreel
