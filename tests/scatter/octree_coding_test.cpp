#include "scatter/octree_coding.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <random>

namespace pointreel {
namespace {

void expect_round_trip(int depth, std::vector<OctreeLeaf> leaves) {
  std::size_t points = 0;
  for (const OctreeLeaf& leaf : leaves) points += leaf.count;
  BitEncoder encoder;
  ASSERT_TRUE(code_octree(encoder, depth, leaves, points));
  const auto bytes = encoder.finish();
  std::vector<OctreeLeaf> decoded;
  BitDecoder decoder(bytes);
  ASSERT_TRUE(code_octree(decoder, depth, decoded, points));
  EXPECT_EQ(decoded, leaves);

  std::vector<OctreeLeaf> too_many;
  BitDecoder again(bytes);
  EXPECT_FALSE(code_octree(again, depth, too_many, points - 1));
}

TEST(Octree, KeysInterleaveAndComeApart) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const std::uint32_t x = random() & 0x1FFFFF, y = random() & 0x1FFFFF, z = random() & 0x1FFFFF;
    const std::uint64_t key = interleaved(x, y, z);
    EXPECT_EQ(every_third_bit(key), x);
    EXPECT_EQ(every_third_bit(key >> 1), y);
    EXPECT_EQ(every_third_bit(key >> 2), z);
  }
  EXPECT_EQ(interleaved(1, 0, 0), 1u);
  EXPECT_EQ(interleaved(0, 0, 2), 32u);
}

TEST(Octree, BringsBackOneCellAndAFullCube) {
  expect_round_trip(0, {{0, 1}});
  expect_round_trip(0, {{0, 70'000}});
  expect_round_trip(kMaxOctreeDepth, {{interleaved(0x1FFFFF, 5, 0x1FFFFF), 3}});
  std::vector<OctreeLeaf> full;
  for (std::uint64_t key = 0; key < 4096; ++key) full.push_back({key, 1});
  expect_round_trip(4, full);
}

RC_GTEST_PROP(Octree, BringsBackAnyCells, ()) {
  const int depth = *rc::gen::inRange(1, kMaxOctreeDepth + 1);
  const auto keys = *rc::gen::nonEmpty(rc::gen::container<std::map<std::uint64_t, std::uint32_t>>(
      rc::gen::arbitrary<std::uint64_t>(), rc::gen::inRange(1u, 9u)));
  std::map<std::uint64_t, std::uint32_t> cells;
  const std::uint64_t mask = (std::uint64_t{1} << (3 * depth)) - 1;
  for (const auto& [key, count] : keys) cells[key & mask] += count;
  std::vector<OctreeLeaf> leaves;
  leaves.reserve(cells.size());
  for (const auto& [key, count] : cells) leaves.push_back({key, count});
  expect_round_trip(depth, leaves);
}

}  // namespace
}  // namespace pointreel
