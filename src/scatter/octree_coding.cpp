#include "scatter/octree_coding.h"

#include <algorithm>
#include <array>
#include <bit>

#include "entropy/bit_mixer.h"
#include "entropy/plain_bits.h"
#include "entropy/wide_integer.h"

namespace pointreel {
namespace {

constexpr std::uint64_t kEveryThird = 0x1249249249249249u;

struct Node {
  std::uint64_t prefix = 0;           // of its leaves' keys
  std::uint32_t begin = 0, end = 0;   // its leaves: encoder only
  std::uint8_t parent_occupancy = 0;  // one bit per octant
};

// Prefix -> index among the nodes of a level.
class NodeIndex {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  explicit NodeIndex(const std::vector<Node>& nodes)
      : nodes_(nodes),
        shift_(64 - static_cast<int>(std::bit_width(2 * nodes.size()))),
        slots_(std::size_t{1} << (64 - shift_), kNone) {
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      std::size_t slot = slot_of(nodes[i].prefix);
      while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
  }

  std::uint32_t find(std::uint64_t prefix) const {
    std::size_t slot = slot_of(prefix);
    while (slots_[slot] != kNone && nodes_[slots_[slot]].prefix != prefix)
      slot = (slot + 1) & (slots_.size() - 1);
    return slots_[slot];
  }

 private:
  std::size_t slot_of(std::uint64_t prefix) const {
    return static_cast<std::size_t>((prefix * 0x9E3779B97F4A7C15u) >> shift_);
  }

  const std::vector<Node>& nodes_;
  int shift_;
  std::vector<std::uint32_t> slots_;
};

// The prefix next to this one along an axis (0 to 2); beyond the cube it is one that no node has, or wraps
// around within the level, which only misleads a context.
std::uint64_t below(std::uint64_t prefix, int axis) {
  const std::uint64_t mask = kEveryThird << axis;
  return (((prefix & mask) - 1) & mask) | (prefix & ~mask);
}
std::uint64_t above(std::uint64_t prefix, int axis) {
  const std::uint64_t mask = kEveryThird << axis;
  return (((prefix | ~mask) + 1) & mask) | (prefix & ~mask);
}

// The four octants of a node on its upper side along the axis, as four bits.
std::uint32_t upper_face(std::uint32_t occupancy, int axis) {
  if (axis == 2) return occupancy >> 4;
  if (axis == 1) return ((occupancy >> 2) & 3u) | ((occupancy >> 4) & 12u);
  return ((occupancy >> 1) & 1u) | ((occupancy >> 2) & 2u) | ((occupancy >> 3) & 4u) |
         ((occupancy >> 4) & 8u);
}

// What predicts a node's occupancy.
struct Surroundings {
  std::uint32_t neighbours = 0;                       // bit 2 axis: below, 2 axis + 1: above
  std::array<std::uint32_t, 3> faces = {16, 16, 16};  // upper_face of the neighbours below; 16: none
};

class OccupancyModel {
 public:
  template <class Coder>
  std::uint8_t code(Coder& coder, const Node& node, const Surroundings& around, int levels_left,
                    std::uint8_t occupancy) {
    const std::array<std::uint32_t, kContexts> context = {
        around.neighbours,
        static_cast<std::uint32_t>(levels_left) * 8 +
            static_cast<std::uint32_t>(std::popcount(node.parent_occupancy)) - 1,
        around.faces[0] * 17 + around.faces[1],
        around.faces[2] * 8 + ((around.neighbours >> 1) & 1u) + ((around.neighbours >> 2) & 2u) +
            ((around.neighbours >> 3) & 4u),
        node.parent_occupancy * 8u + static_cast<std::uint32_t>(node.prefix & 7)};
    std::array<CountedBit*, kContexts> base;
    for (std::size_t i = 0; i < kContexts; ++i) base[i] = bits_[i].data() + context[i] * kDecisions;

    // Most nodes near the leaves have one child: one decision says so, three say which.
    if (code_bit(coder, base, 0, std::has_single_bit(occupancy))) {
      std::uint32_t octant = 1;
      const auto wanted = static_cast<std::uint32_t>(std::countr_zero(occupancy));
      for (int bit = 2; bit >= 0; --bit) {
        octant = (octant << 1) | (code_bit(coder, base, octant, (wanted >> bit) & 1u) ? 1u : 0u);
      }
      return static_cast<std::uint8_t>(1u << (octant - 8));
    }
    std::uint32_t tree = 1;
    for (int octant = 0; octant < 8; ++octant) {
      tree = (tree << 1) | (code_bit(coder, base, kFirstOfTree + tree, (occupancy >> octant) & 1u) ? 1u : 0u);
    }
    // The first octant came first and lies highest.
    std::uint32_t result = 0;
    for (int octant = 0; octant < 8; ++octant) result |= ((tree >> (7 - octant)) & 1u) << octant;
    return static_cast<std::uint8_t>(result);
  }

 private:
  static constexpr std::size_t kContexts = 5;
  static constexpr std::uint32_t kFirstOfTree = 7, kDecisions = kFirstOfTree + 256;
  static constexpr int kRateLimit = 30;
  static constexpr int kMixingRateShift = 13;
  static constexpr Stretch kBias = 256;
  using Mixer = BitMixer<kContexts + 1>;

  template <class Coder>
  bool code_bit(Coder& coder, const std::array<CountedBit*, kContexts>& base, std::uint32_t decision,
                bool bit) {
    Mixer::Inputs inputs;
    for (std::size_t i = 0; i < kContexts; ++i) inputs[i] = base[i][decision].stretch();
    inputs[kContexts] = kBias;
    Mixer& mixer = mixers_[decision];
    const Probability16 p_one = mixer.p_one(inputs);
    const bool coded = coder.code_with(bit, p_one);
    mixer.update<kMixingRateShift>(inputs, p_one, coded);
    for (std::size_t i = 0; i < kContexts; ++i) base[i][decision].update<kRateLimit>(coded);
    return coded;
  }

  static std::vector<CountedBit> contexts(std::size_t count) {
    return std::vector<CountedBit>(count * kDecisions);
  }
  std::array<std::vector<CountedBit>, kContexts> bits_ = {contexts(64), contexts((kMaxOctreeDepth + 1) * 8),
                                                          contexts(17 * 17), contexts(17 * 8),
                                                          contexts(256 * 8)};
  std::vector<Mixer> mixers_ = std::vector<Mixer>(kDecisions, Mixer::with_weights(16'000));
};

template <class Coder>
class OctreeCoder {
 public:
  OctreeCoder(Coder& coder, std::vector<OctreeLeaf>& leaves, std::size_t points_limit)
      : coder_(coder), leaves_(leaves), points_left_(points_limit) {}

  bool code(int depth) {
    std::vector<Node> nodes(1);
    nodes[0].end = static_cast<std::uint32_t>(leaves_.size());
    nodes[0].parent_occupancy = 1;
    for (int levels_left = depth; levels_left > 0; --levels_left) {
      std::vector<Node> children;
      if (!code_level(nodes, levels_left, children)) return false;
      nodes = std::move(children);
    }
    for (const Node& node : nodes) {
      if (!code_leaf(node.prefix, node.begin)) return false;
    }
    if constexpr (Coder::kDecodes) {
      std::sort(leaves_.begin(), leaves_.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    }
    return true;
  }

 private:
  bool code_level(const std::vector<Node>& nodes, int levels_left, std::vector<Node>& children) {
    const NodeIndex index(nodes);
    std::vector<std::uint8_t> occupancies(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if constexpr (Coder::kDecodes) {
        if (coder_.overran() || children.size() + (nodes.size() - i) > points_left_) return false;
      }
      const Node& node = nodes[i];
      const Surroundings around = surroundings(node, index, occupancies);

      // A lonely node in a lonely chain most likely leads to one leaf, of which nothing more can be
      // predicted.
      if (around.neighbours == 0 && std::has_single_bit(node.parent_occupancy) &&
          coder_.code(leads_to_one_[static_cast<std::size_t>(levels_left)], node.end - node.begin == 1)) {
        const std::uint64_t known = node.prefix << (3 * levels_left);
        const std::uint64_t wanted = Coder::kDecodes ? 0 : leaves_[node.begin].key - known;
        const std::uint64_t rest = code_plain_bits(coder_, wanted, 3 * levels_left);
        occupancies[i] = static_cast<std::uint8_t>(1u << (rest >> (3 * (levels_left - 1))));
        if (!code_leaf(known + rest, node.begin)) return false;
        continue;
      }

      std::array<std::uint32_t, 9> begin{};  // of each octant's leaves
      if constexpr (!Coder::kDecodes) begin = octant_begins(node, levels_left);
      std::uint8_t occupancy = 0;
      for (std::size_t octant = 0; octant < 8; ++octant) {
        if (begin[octant] != begin[octant + 1]) occupancy |= static_cast<std::uint8_t>(1u << octant);
      }
      occupancy = model_.code(coder_, node, around, levels_left, occupancy);
      if (occupancy == 0) return false;
      occupancies[i] = occupancy;
      for (std::size_t octant = 0; octant < 8; ++octant) {
        if ((occupancy >> octant) & 1u) {
          children.push_back({(node.prefix << 3) | octant, begin[octant], begin[octant + 1], occupancy});
        }
      }
    }
    return true;
  }

  static Surroundings surroundings(const Node& node, const NodeIndex& index,
                                   const std::vector<std::uint8_t>& occupancies) {
    Surroundings around;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t lower = index.find(below(node.prefix, axis));
      if (lower != NodeIndex::kNone) {
        around.neighbours |= 1u << (2 * axis);
        around.faces[static_cast<std::size_t>(axis)] = upper_face(occupancies[lower], axis);
      }
      if (index.find(above(node.prefix, axis)) != NodeIndex::kNone) around.neighbours |= 2u << (2 * axis);
    }
    return around;
  }

  std::array<std::uint32_t, 9> octant_begins(const Node& node, int levels_left) const {
    std::array<std::uint32_t, 9> begin{};
    std::uint32_t leaf = node.begin;
    for (std::uint64_t octant = 0; octant < 8; ++octant) {
      begin[octant] = leaf;
      while (leaf < node.end && ((leaves_[leaf].key >> (3 * (levels_left - 1))) & 7) == octant) ++leaf;
    }
    begin[8] = leaf;
    return begin;
  }

  bool code_leaf(std::uint64_t key, std::uint32_t leaf) {
    const std::uint64_t more = more_points_.code(coder_, Coder::kDecodes ? 0 : leaves_[leaf].count - 1);
    if (more >= points_left_) return false;
    points_left_ -= static_cast<std::size_t>(more) + 1;
    if constexpr (Coder::kDecodes) {
      if (coder_.overran()) return false;
      leaves_.push_back({key, static_cast<std::uint32_t>(more + 1)});
    }
    return true;
  }

  Coder& coder_;
  std::vector<OctreeLeaf>& leaves_;
  std::size_t points_left_;
  OccupancyModel model_;
  AdaptiveWideInteger more_points_{4};
  std::array<AdaptiveBit, kMaxOctreeDepth + 1> leads_to_one_;
};

}  // namespace

std::uint64_t interleaved(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const auto spread = [](std::uint64_t bits) {
    bits &= 0x1FFFFF;
    bits = (bits | bits << 32) & 0x001F00000000FFFFu;
    bits = (bits | bits << 16) & 0x001F0000FF0000FFu;
    bits = (bits | bits << 8) & 0x100F00F00F00F00Fu;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3u;
    return (bits | bits << 2) & kEveryThird;
  };
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

std::uint32_t every_third_bit(std::uint64_t key) {
  std::uint64_t bits = key & kEveryThird;
  bits = (bits | bits >> 2) & 0x10C30C30C30C30C3u;
  bits = (bits | bits >> 4) & 0x100F00F00F00F00Fu;
  bits = (bits | bits >> 8) & 0x001F0000FF0000FFu;
  bits = (bits | bits >> 16) & 0x001F00000000FFFFu;
  return static_cast<std::uint32_t>((bits | bits >> 32) & 0x1FFFFF);
}

template <class Coder>
bool code_octree(Coder& coder, int depth, std::vector<OctreeLeaf>& leaves, std::size_t points_limit) {
  return OctreeCoder<Coder>(coder, leaves, points_limit).code(depth);
}

template bool code_octree(BitEncoder&, int, std::vector<OctreeLeaf>&, std::size_t);
template bool code_octree(BitDecoder&, int, std::vector<OctreeLeaf>&, std::size_t);

}  // namespace pointreel
