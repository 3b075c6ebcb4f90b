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

constexpr std::uint32_t kWarped = kWarpedHit | kWarpedFilled;

// Steps between log ranges, and their classes.
constexpr int kSameSurface = 30;      // 1 to 1.5 %
constexpr int kSlantedSurface = 115;  // 4 to 6 %
constexpr int kNearby = 60;
constexpr int kFarApart = 775;  // a factor of 1.3

// Class of the step between two ranges: 0 unknown, 1 same surface, 2 slanted, 3 an edge.
std::uint32_t edge_class(int a, int b) {
  if (a == 0 || b == 0) return 0;
  const int step = std::abs(a - b);
  return 1u + (step >= kSameSurface ? 1u : 0u) + (step >= kSlantedSurface ? 1u : 0u);
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
    for (int slot = 0; slot < kSlots[context]; ++slot, ++prior) {
      const Stretch stretch = (*prior >> 2) * kPriorStep - kMaxStretch + kPriorStep / 2 - 1;
      bits.emplace_back(squash(stretch), kPriorCounts[*prior & 3]);
    }
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
    : band_(band),
      reference_(reference),
      contexts_(reference.empty() ? HitMaskState::kReference : HitMaskState::kContexts),
      state_(std::move(state)) {
  const auto columns = static_cast<std::size_t>(band_.columns);
  // Nothing is known above the band: hits are the better guess than misses.
  for (Row* row : {&current_, &above_, &above2_}) {
    row->hits.assign(columns + 2 * kPadding, 1);
    row->ranges.assign(columns, 0);
    row->edges.assign(columns, 0);
  }
  column_range_.assign(columns, 0);
  column_history_.assign(columns, 0xFF);
}

void HitMaskModel::begin_row() {
  if (row_ >= 0) finish_row();
  ++row_;
  column_ = 0;
  window_above_ = window_above2_ = window_sum_ = 0;
  for (std::size_t i = 0; i < kPadding + kAhead; ++i) {
    window_above_ = window_above_ << 1 | above_.hits[i];
    window_above2_ = window_above2_ << 1 | above2_.hits[i];
    window_sum_ += above_.hits[i] + above2_.hits[i];
  }
  // The row's last cells, left of column 0 on the cylinder, are not known yet: take those above.
  window_row_ = window_above_ >> kAhead;
  run_ = 1;
  row_range_ = 0;
  if (!reference_.empty()) {
    const std::uint8_t* cells =
        reference_.data() + static_cast<std::size_t>(row_) * static_cast<std::size_t>(band_.columns);
    reference_window_ = static_cast<std::uint32_t>(cells[band_.columns - 1]) << 3 | cells[0];
  }
}

void HitMaskModel::finish_row() {
  const auto columns = static_cast<std::size_t>(band_.columns);
  for (std::size_t i = 0; i < kPadding; ++i) {
    current_.hits[i] = current_.hits[kPadding + (columns * kPadding + i - kPadding) % columns];
    current_.hits[kPadding + columns + i] = current_.hits[kPadding + i % columns];
  }
  for (std::size_t c = 0; c < columns; ++c) {
    const std::size_t next = c + 1 < columns ? c + 1 : 0;
    current_.edges[c] = static_cast<std::uint8_t>(edge_class(current_.ranges[c], current_.ranges[next]));
  }
  std::swap(above2_, above_);
  std::swap(above_, current_);
}

Probability16 HitMaskModel::predict() {
  const auto c = static_cast<std::size_t>(column_);
  const auto columns = static_cast<std::size_t>(band_.columns);
  const std::size_t before = c > 0 ? c - 1 : columns - 1;

  const std::uint8_t entering = above_.hits[kPadding + c + kAhead];
  const std::uint8_t entering2 = above2_.hits[kPadding + c + kAhead];
  window_above_ = window_above_ << 1 | entering;
  window_above2_ = window_above2_ << 1 | entering2;
  const std::uint32_t window_sum = window_sum_ + entering + entering2 - above_.hits[c] - above2_.hits[c];
  window_sum_ = window_sum;

  const std::uint32_t west = window_row_ & 1;
  const std::uint32_t north = window_above_ >> kAhead & 1;
  const std::uint32_t north_east = window_above_ >> (kAhead - 1) & 1;
  const std::uint32_t north_west = window_above_ >> (kAhead + 1) & 1;
  const std::uint32_t north2 = window_above2_ >> kAhead & 1;
  const std::uint32_t west_north = west | north << 1;

  const LogRange range_above = column_range_[c];
  std::array<std::uint32_t, HitMaskState::kContexts> context;
  context[HitMaskState::kRange] = west_north | north2 << 2 |
                                  range_class(row_range_ != 0 ? row_range_ : range_above) << 3 |
                                  order_class(range_above, row_range_) << 7;
  context[HitMaskState::kRuns] = run_class(run_) | west << 3 | (window_above_ >> (kAhead - 3) & 31) << 4;
  context[HitMaskState::kRow] = static_cast<std::uint32_t>(row_) << 3 | west_north | north2 << 2;
  context[HitMaskState::kEdges] = west_north | static_cast<std::uint32_t>(above2_.edges[c]) << 2 |
                                  static_cast<std::uint32_t>(above2_.edges[before]) << 4 |
                                  edge_class(row_range_, above2_.ranges[before]) << 6 |
                                  static_cast<std::uint32_t>(above_.edges[c]) << 8;
  context[HitMaskState::kDensity] = static_cast<std::uint32_t>(kColumnShares[column_history_[c]]) |
                                    static_cast<std::uint32_t>(kWindowShares[window_sum]) << 3 |
                                    static_cast<std::uint32_t>(kRowShares[window_row_ & 15]) << 6 |
                                    north << 8 | north_east << 9;
  if (!reference_.empty()) {
    const std::size_t next = c + 1 < columns ? c + 1 : 0;
    reference_window_ = reference_window_ << 3 | reference_[static_cast<std::size_t>(row_) * columns + next];
    const std::uint32_t east = reference_window_ & 7;
    const std::uint32_t here = reference_window_ >> 3 & 7;
    const std::uint32_t left = reference_window_ >> 6 & 7;
    const auto quarter =
        static_cast<std::uint32_t>((band_.first_row + row_) * 4 / std::max(1, band_.image_rows));
    context[HitMaskState::kReference] = here | (left >> 2) << 3 | (east >> 2) << 4 | west_north << 5 |
                                        ((left & kWarped) != 0 ? 1u : 0u) << 7 |
                                        ((east & kWarped) != 0 ? 1u : 0u) << 8 | (quarter & 3) << 9;
  }

  for (std::size_t i = 0; i < contexts_; ++i) {
    slots_[i] = &state_.bits[i][context[i]];
    inputs_[i] = slots_[i]->stretch();
  }
  mixer_ = &state_.mixers[west_north | north_east << 2 | (window_row_ & 2) << 2 | north_west << 4 |
                          (reference_.empty() ? 0u : 32u)];
  return mixer_->p_one(inputs_);
}

void HitMaskModel::learn(bool hit, Probability16 p_one) {
  mixer_->update(inputs_, p_one, hit);
  for (std::size_t i = 0; i < contexts_; ++i) slots_[i]->update(hit);

  const auto c = static_cast<std::size_t>(column_);
  const std::uint32_t bit = hit ? 1 : 0;
  run_ = (window_row_ & 1) == bit ? run_ + 1 : 1;
  window_row_ = window_row_ << 1 | bit;
  column_history_[c] = static_cast<std::uint8_t>(column_history_[c] << 1 | bit);
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
