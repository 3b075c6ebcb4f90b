#include "sensor/order_moves.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/expect_error.h"

namespace pointreel {
namespace {

TEST(OrderMoves, ListInOrderNeedsNone) {
  const std::vector<std::uint32_t> cells = {4, 7, 9};
  EXPECT_TRUE(find_moves(cells, cells, 10).empty());
  EXPECT_TRUE(encode_moves({}).empty());
}

TEST(OrderMoves, OnePointThatJumpsIsOneMove) {
  const std::vector<std::uint32_t> expected = {0, 1, 2, 3, 4, 5};
  const std::vector<std::uint32_t> actual = {5, 0, 1, 2, 3, 4};
  const auto moves = find_moves(expected, actual, 6);
  EXPECT_EQ(moves, (std::vector<OrderMove>{{5, 0}}));
  EXPECT_EQ(apply_moves(expected, moves), actual);
}

RC_GTEST_PROP(OrderMoves, BringBackAnyPermutation, ()) {
  std::vector<std::uint32_t> expected(*rc::gen::inRange<std::size_t>(0, 60));
  std::iota(expected.begin(), expected.end(), 3u);
  auto actual = expected;
  const auto swaps = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, 60));
  for (const std::size_t i : swaps) {
    if (!actual.empty()) std::swap(actual[i % actual.size()], actual[(i * 7 + 1) % actual.size()]);
  }
  const auto moves = find_moves(expected, actual, 64);
  const auto decoded = decode_moves(expected.size(), encode_moves(moves));
  RC_ASSERT(static_cast<bool>(decoded));
  RC_ASSERT(*decoded == moves);
  RC_ASSERT(apply_moves(expected, *decoded) == actual);
}

RC_GTEST_PROP(OrderMoves, AnyBytesAreAnErrorOrMovesWithinTheList, (std::vector<std::uint8_t> bytes)) {
  std::vector<std::uint32_t> list(40);
  std::iota(list.begin(), list.end(), 0u);
  const auto moves = decode_moves(list.size(), bytes);
  if (!moves) return;
  auto moved = apply_moves(list, *moves);
  std::sort(moved.begin(), moved.end());
  RC_ASSERT(moved == list);
}

}  // namespace
}  // namespace pointreel
