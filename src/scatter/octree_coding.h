// The occupied cells of a cubic lattice of 2^depth cells an axis, with how many points each holds, as an
// octree coded level by level: so a node knows which of its neighbours are occupied, and the insides of those
// before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_models.h"

namespace pointreel {

inline constexpr int kMaxOctreeDepth = 21;  // three indices in 63 bits

struct OctreeLeaf {
  std::uint64_t key = 0;  // bits of x, y, z interleaved, x lowest
  std::uint32_t count = 0;
  friend bool operator==(const OctreeLeaf&, const OctreeLeaf&) = default;
};

std::uint64_t interleaved(std::uint32_t x, std::uint32_t y, std::uint32_t z);
std::uint32_t every_third_bit(std::uint64_t key);  // the x of a key; those of key >> 1, key >> 2 are y and z

// `leaves` ascending by key, each at least once, not empty; a decoder fills them in. False when a decoder
// finds more than points_limit points, or overruns.
template <class Coder>
bool code_octree(Coder& coder, int depth, std::vector<OctreeLeaf>& leaves, std::size_t points_limit);

extern template bool code_octree(BitEncoder&, int, std::vector<OctreeLeaf>&, std::size_t);
extern template bool code_octree(BitDecoder&, int, std::vector<OctreeLeaf>&, std::size_t);

}  // namespace pointreel
