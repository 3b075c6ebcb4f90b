// The few points whose place in the cloud is not the one that the grid's order says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/result.h"

namespace pointreel {

// The element at `from` of the expected list stands at `to` of the actual one; all others keep their
// sequence.
struct OrderMove {
  std::uint32_t from = 0, to = 0;
  friend bool operator==(const OrderMove&, const OrderMove&) = default;
};

// Positions that no longest strictly increasing subsequence of the keys holds.
std::vector<std::uint32_t> order_breakers(std::span<const std::uint32_t> keys);

// The fewest moves, by ascending `from`. Both lists hold the same cells, each below `cells` and once.
std::vector<OrderMove> find_moves(std::span<const std::uint32_t> expected,
                                  std::span<const std::uint32_t> actual, std::size_t cells);
std::size_t count_moves(std::span<const std::uint32_t> expected, std::span<const std::uint32_t> actual,
                        std::size_t cells);
// The actual list. The moves must be those of find_moves or of decode_moves for a list of this size.
std::vector<std::uint32_t> apply_moves(std::span<const std::uint32_t> expected,
                                       std::span<const OrderMove> moves);

// About 20 bits a move, none when there are none.
std::vector<std::uint8_t> encode_moves(std::span<const OrderMove> moves);
Result<std::vector<OrderMove>> decode_moves(std::size_t list_size, std::span<const std::uint8_t> bytes);

}  // namespace pointreel
