#include "sensor/firing_sequence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace pointreel {
namespace {

// Rows in the order in which the points of a slot come; slot_of_point < 0: none.
std::vector<std::uint16_t> row_sequence_of(const std::vector<std::int16_t>& rows,
                                           std::span<const std::int32_t> slot_of_point,
                                           std::size_t row_count) {
  // Mean rank within the slots, which is off by what is missing before a row: full slots count for more.
  std::vector<std::vector<std::int16_t>> slots;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0 || slot_of_point[i] < 0) continue;
    const auto slot = static_cast<std::size_t>(slot_of_point[i]);
    if (slot >= slots.size()) slots.resize(slot + 1);
    slots[slot].push_back(rows[i]);
  }
  std::vector<double> rank(row_count, 0);
  std::vector<double> weight(row_count, 0);
  for (const auto& slot : slots) {
    const double full = static_cast<double>(slot.size()) / static_cast<double>(row_count);
    const double w = std::pow(full, 8) + 1e-12;
    for (std::size_t k = 0; k < slot.size(); ++k) {
      const auto r = static_cast<std::size_t>(slot[k]);
      rank[r] += w * (static_cast<double>(k) + 0.5) / static_cast<double>(slot.size());
      weight[r] += w;
    }
  }
  for (std::size_t r = 0; r < row_count; ++r) rank[r] = weight[r] > 0 ? rank[r] / weight[r] : 0;
  std::vector<std::uint16_t> sequence(row_count);
  std::iota(sequence.begin(), sequence.end(), std::uint16_t{0});
  std::stable_sort(sequence.begin(), sequence.end(),
                   [&](std::uint16_t a, std::uint16_t b) { return rank[a] < rank[b]; });
  return sequence;
}

// By how many columns each row lags behind the fullest one, most often: the column that one fired last, less
// the row's own.
std::vector<std::int32_t> lag_of_rows(const std::vector<std::int16_t>& rows,
                                      std::span<const std::int32_t> fired_column, std::size_t row_count) {
  constexpr std::int32_t kMostLag = 64;
  std::vector<std::size_t> points(row_count, 0);
  for (const std::int16_t row : rows) {
    if (row >= 0) ++points[static_cast<std::size_t>(row)];
  }
  const auto fullest =
      static_cast<std::int16_t>(std::max_element(points.begin(), points.end()) - points.begin());
  std::vector<std::vector<std::uint32_t>> votes(row_count, std::vector<std::uint32_t>(2 * kMostLag + 1, 0));
  std::int32_t now = -1;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0 || fired_column[i] < 0) continue;
    if (rows[i] == fullest) now = fired_column[i];
    const std::int32_t lag = now - fired_column[i];
    if (now < 0 || lag < -kMostLag || lag > kMostLag) continue;
    ++votes[static_cast<std::size_t>(rows[i])][static_cast<std::size_t>(lag + kMostLag)];
  }
  std::vector<std::int32_t> lags(row_count, 0);
  for (std::size_t r = 0; r < row_count; ++r) {
    const auto most = std::max_element(votes[r].begin(), votes[r].end());
    if (*most > 0) lags[r] = static_cast<std::int32_t>(most - votes[r].begin()) - kMostLag;
  }
  return lags;
}

std::vector<std::int32_t> slots_of(const std::vector<std::int16_t>& rows,
                                   std::span<const std::int32_t> fired_column,
                                   const std::vector<std::int32_t>& lags) {
  std::int32_t least = 0;
  for (const std::int32_t lag : lags) least = std::min(least, lag);
  std::vector<std::int32_t> slots(rows.size(), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] >= 0 && fired_column[i] >= 0)
      slots[i] = fired_column[i] + lags[static_cast<std::size_t>(rows[i])] - least;
  }
  return slots;
}

// Where a round of all rows begins is a matter of taste: where the fewest rows are late. Rows from `cut` on
// in the sequence then come first, a column earlier.
void begin_round_at_best(std::vector<std::uint16_t>& sequence, std::vector<std::int32_t>& lags) {
  const auto late_rows = [&](std::size_t cut) {
    std::vector<std::int32_t> turned;
    for (std::size_t k = 0; k < sequence.size(); ++k)
      turned.push_back(lags[sequence[k]] + (k >= cut ? 1 : 0));
    const std::int32_t least = *std::min_element(turned.begin(), turned.end());
    return sequence.size() - static_cast<std::size_t>(std::count(turned.begin(), turned.end(), least));
  };
  std::size_t best = sequence.size();
  for (std::size_t cut = 1; cut < sequence.size(); ++cut) {
    if (late_rows(cut) < late_rows(best)) best = cut;
  }
  for (std::size_t k = best; k < sequence.size(); ++k) ++lags[sequence[k]];
  std::rotate(sequence.begin(), sequence.begin() + static_cast<std::ptrdiff_t>(best), sequence.end());
}

// Points that do not come after the point before them.
std::size_t count_breaks(const std::vector<std::int16_t>& rows, std::span<const std::int32_t> slots,
                         const std::vector<std::uint16_t>& sequence) {
  std::vector<std::int32_t> rank(sequence.size());
  for (std::size_t k = 0; k < sequence.size(); ++k) rank[sequence[k]] = static_cast<std::int32_t>(k);
  std::size_t breaks = 0;
  std::int64_t before = -1;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (slots[i] < 0) continue;
    const std::int64_t place = std::int64_t{slots[i]} * static_cast<std::int64_t>(rank.size()) +
                               rank[static_cast<std::size_t>(rows[i])];
    breaks += place <= before ? 1 : 0;
    before = place;
  }
  return breaks;
}

}  // namespace

FiringSequence find_firing_sequence(const std::vector<std::int16_t>& rows,
                                    std::span<const std::int32_t> fired_column, std::size_t row_count) {
  FiringSequence plain{row_sequence_of(rows, fired_column, row_count), {}};
  auto lags = lag_of_rows(rows, fired_column, row_count);
  auto sequence = row_sequence_of(rows, slots_of(rows, fired_column, lags), row_count);
  begin_round_at_best(sequence, lags);
  if (count_breaks(rows, slots_of(rows, fired_column, lags), sequence) >=
      count_breaks(rows, fired_column, plain.rows))
    return plain;
  FiringSequence staggered{std::move(sequence), {}};
  const auto [least, most] = std::minmax_element(lags.begin(), lags.end());
  if (*least == *most) return staggered;
  for (const std::int32_t lag : lags) staggered.delay.push_back(static_cast<std::uint16_t>(lag - *least));
  return staggered;
}

}  // namespace pointreel
