#include "sensor/order_moves.h"

#include <algorithm>
#include <memory>

#include "base/first_where.h"
#include "entropy/adaptive_models.h"

namespace pointreel {
namespace {

struct MoveModels {
  AdaptiveInteger count, gap, distance;
};

template <class Coder>
OrderMove code_move(Coder& coder, MoveModels& models, std::int64_t last_from, const OrderMove& move) {
  const auto gap = models.gap.code(coder, static_cast<std::int32_t>(move.from - last_from - 1));
  const std::int64_t from = last_from + 1 + gap;
  const auto distance = models.distance.code(
      coder,
      static_cast<std::int32_t>(static_cast<std::int64_t>(move.to) - static_cast<std::int64_t>(move.from)));
  return {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(from + distance)};
}

}  // namespace

std::vector<std::uint32_t> order_breakers(std::span<const std::uint32_t> keys) {
  const auto count = static_cast<std::uint32_t>(keys.size());
  // Last element of the best subsequence of each length, and its key.
  std::vector<std::uint32_t> tails;
  std::vector<std::uint32_t> tail_keys;
  tails.reserve(keys.size());
  tail_keys.reserve(keys.size());
  std::vector<std::uint32_t> before(keys.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t key = keys[i];
    if (tails.empty() || tail_keys.back() < key) {
      before[i] = tails.empty() ? count : tails.back();
      tails.push_back(i);
      tail_keys.push_back(key);
      continue;
    }
    const auto place = static_cast<std::size_t>(std::lower_bound(tail_keys.begin(), tail_keys.end(), key) -
                                                tail_keys.begin());
    before[i] = place == 0 ? count : tails[place - 1];
    tails[place] = i;
    tail_keys[place] = key;
  }
  std::vector<std::uint32_t> breakers;
  std::uint32_t kept = tails.empty() ? count : tails.back();
  for (std::uint32_t i = count; i-- > 0;) {
    if (i == kept) {
      kept = before[i];
    } else {
      breakers.push_back(i);
    }
  }
  std::reverse(breakers.begin(), breakers.end());
  return breakers;
}

namespace {

// Calls take(first, keys) for each of the shortest stretches that hold the same elements in another sequence;
// keys: each actual element's place in the expected list. Elsewhere the lists are alike.
template <class Take>
void for_each_difference(std::span<const std::uint32_t> expected, std::span<const std::uint32_t> actual,
                         std::size_t cells, const Take& take) {
  const std::uint32_t *there = expected.data(), *here = actual.data();
  const auto differs = [=](std::size_t i) { return static_cast<int>(there[i] != here[i]); };
  const std::size_t first = first_where(0, actual.size(), differs);
  std::size_t last = actual.size();
  while (last > first && expected[last - 1] == actual[last - 1]) --last;
  if (first == last) return;
  const auto place = std::make_unique_for_overwrite<std::uint32_t[]>(cells);
  for (std::size_t i = first; i < last; ++i) place[expected[i]] = static_cast<std::uint32_t>(i);
  std::vector<std::uint32_t> keys;
  for (std::size_t i = first; i < last; i = first_where(i, last, differs)) {
    keys.clear();
    const std::size_t begin = i;
    for (std::size_t end = i + 1; i < end; ++i) {
      keys.push_back(place[actual[i]]);
      end = std::max(end, std::size_t{keys.back()} + 1);
    }
    take(begin, std::span<const std::uint32_t>(keys));
  }
}

}  // namespace

std::vector<OrderMove> find_moves(std::span<const std::uint32_t> expected,
                                  std::span<const std::uint32_t> actual, std::size_t cells) {
  std::vector<OrderMove> moves;
  for_each_difference(expected, actual, cells, [&](std::size_t first, std::span<const std::uint32_t> keys) {
    for (const std::uint32_t i : order_breakers(keys))
      moves.push_back({keys[i], static_cast<std::uint32_t>(first) + i});
  });
  std::sort(moves.begin(), moves.end(),
            [](const OrderMove& a, const OrderMove& b) { return a.from < b.from; });
  return moves;
}

std::size_t count_moves(std::span<const std::uint32_t> expected, std::span<const std::uint32_t> actual,
                        std::size_t cells) {
  std::size_t moves = 0;
  for_each_difference(expected, actual, cells, [&](std::size_t, std::span<const std::uint32_t> keys) {
    moves += order_breakers(keys).size();
  });
  return moves;
}

std::vector<std::uint32_t> apply_moves(std::span<const std::uint32_t> expected,
                                       std::span<const OrderMove> moves) {
  std::vector<std::uint32_t> actual(expected.begin(), expected.end());
  if (moves.empty()) return actual;
  std::vector<std::uint8_t> left(expected.size(), 0);
  std::vector<std::uint8_t> taken(expected.size(), 0);
  for (const OrderMove& move : moves) {
    left[move.from] = 1;
    taken[move.to] = 1;
    actual[move.to] = expected[move.from];
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (left[i] != 0) continue;
    while (taken[next] != 0) ++next;
    actual[next++] = expected[i];
  }
  return actual;
}

std::vector<std::uint8_t> encode_moves(std::span<const OrderMove> moves) {
  if (moves.empty()) return {};
  BitEncoder coder;
  MoveModels models;
  models.count.code(coder, static_cast<std::int32_t>(moves.size()));
  std::int64_t last = -1;
  for (const OrderMove& move : moves) last = code_move(coder, models, last, move).from;
  return coder.finish();
}

Result<std::vector<OrderMove>> decode_moves(std::size_t list_size, std::span<const std::uint8_t> bytes) {
  std::vector<OrderMove> moves;
  if (bytes.empty()) return moves;
  BitDecoder coder(bytes);
  MoveModels models;
  const std::int32_t count = models.count.code(coder, 0);
  if (count < 0 || static_cast<std::size_t>(count) > list_size)
    return Error{ErrorCode::corrupt, "more points are moved than there are"};
  std::vector<std::uint8_t> taken(list_size, 0);
  std::int64_t last = -1;
  for (std::int32_t i = 0; i < count; ++i) {
    const OrderMove move = code_move(coder, models, last, {});
    if (coder.overran()) return Error{ErrorCode::truncated, "the moved points end early"};
    if (static_cast<std::int64_t>(move.from) <= last || move.from >= list_size || move.to >= list_size ||
        taken[move.to] != 0)
      return Error{ErrorCode::corrupt, "a moved point has no place"};
    taken[move.to] = 1;
    last = move.from;
    moves.push_back(move);
  }
  return moves;
}

}  // namespace pointreel
