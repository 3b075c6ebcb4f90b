#include "fields/symbol_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>
#include <utility>

namespace pointreel {
namespace {

constexpr std::uint32_t kGroupClasses = 34, kStepClasses = 11, kRangeClasses = 32;

// Two classes an octave from 1 m upwards... of the range, for the return weakens with it.
std::uint32_t range_class(float range_m) {
  const std::int32_t half_octaves =
      static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(range_m) >> 22) - (0x3F800000 >> 22);
  return static_cast<std::uint32_t>(std::clamp<std::int32_t>(half_octaves + 2, 0, kRangeClasses - 1));
}

// Is the neighbour on the same surface, and if not, before or behind?
std::uint32_t step_class(float step_m) {
  const float size_m = std::fabs(step_m);
  const std::uint32_t size = size_m < 0.03f  ? 0u
                             : size_m < 0.1f ? 1u
                             : size_m < 0.3f ? 2u
                             : size_m < 1    ? 3u
                             : size_m < 4    ? 4u
                                             : 5u;
  return step_m < 0 && size > 0 ? 5 + size : size;
}

}  // namespace

SymbolModel::SymbolModel(std::span<const std::uint64_t> weights, std::uint32_t rows)
    : groups_(static_cast<std::uint32_t>(weights.size())), rows_(std::clamp(rows, 1u, 256u)) {
  while (groups_ > kMaxGroups) {
    ++low_bits_;
    groups_ = (groups_ + 1) / 2;
  }
  std::vector<std::uint64_t> mass_before(groups_ + 1, 0);
  for (std::size_t i = 0; i < weights.size(); ++i) mass_before[(i >> low_bits_) + 1] += weights[i];
  for (std::uint32_t i = 0; i < groups_; ++i) mass_before[i + 1] += mass_before[i];
  grow(mass_before);
  class_of_ = quantiles(mass_before);

  const std::array<std::size_t, kContexts> contexts = {std::size_t{groups_} * kStepClasses,
                                                       std::size_t{kGroupClasses} * kGroupClasses,
                                                       std::size_t{rows_} * kRangeClasses};
  for (std::size_t i = 0; i < kContexts; ++i)
    bits_[i].resize(contexts[i] * std::max<std::size_t>(nodes_.size(), 1));
  low_.resize(std::size_t{groups_} << low_bits_);
}

// Splits groups where their mass does. Breadth first: the decisions taken most lie together.
void SymbolModel::grow(std::span<const std::uint64_t> mass_before) {
  struct Open {
    std::uint32_t first, end;  // groups, at least one
    std::int32_t* child_of_parent_at(std::vector<Node>& nodes) const {
      return &nodes[parent].child[is_above];
    }
    std::size_t parent;
    bool is_above;
  };
  std::deque<Open> open = {{0, groups_, 0, false}};
  while (!open.empty()) {
    const Open part = open.front();
    open.pop_front();
    const bool leaf = part.end - part.first == 1;
    const std::int32_t self =
        leaf ? ~static_cast<std::int32_t>(part.first) : static_cast<std::int32_t>(nodes_.size());
    if (nodes_.empty()) {
      root_ = self;
    } else {
      *part.child_of_parent_at(nodes_) = self;
    }
    if (leaf) continue;
    const std::uint64_t twice_middle = mass_before[part.first] + mass_before[part.end];
    std::uint32_t split = part.first + 1;
    while (split + 1 < part.end && mass_before[split] + mass_before[split + 1] <= twice_middle) ++split;
    nodes_.push_back({split, {}, Mixer::with_weights(kFirstWeight)});
    open.push_back({part.first, split, nodes_.size() - 1, false});
    open.push_back({split, part.end, nodes_.size() - 1, true});
  }
}

std::vector<std::uint8_t> SymbolModel::quantiles(std::span<const std::uint64_t> mass_before) const {
  std::vector<std::uint8_t> result(groups_);
  for (std::uint32_t group = 0; group < groups_; ++group) {
    const std::uint64_t twice_middle = mass_before[group] + mass_before[group + 1];
    result[group] = static_cast<std::uint8_t>(twice_middle * kGroupClasses / (2 * mass_before[groups_] + 1));
  }
  return result;
}

template <class Coder>
std::uint32_t SymbolModel::code_group(Coder& coder, const std::array<std::uint32_t, kContexts>& context,
                                      std::uint32_t group) {
  std::array<CountedBit*, kContexts> base{};
  for (std::size_t i = 0; i < kContexts; ++i) base[i] = bits_[i].data() + context[i] * nodes_.size();
  Mixer::Inputs inputs;
  inputs[kContexts] = kBias;
  std::int32_t at = root_;
  while (at >= 0) {
    const auto index = static_cast<std::size_t>(at);
    Node& node = nodes_[index];
    for (std::size_t i = 0; i < kContexts; ++i) inputs[i] = base[i][index].stretch();
    const Probability16 p_one = node.mixer.p_one(inputs);
    const bool bit = coder.code_with(group >= node.split, p_one);
    node.mixer.template update<kMixingRateShift>(inputs, p_one, bit);
    for (std::size_t i = 0; i < kContexts; ++i) base[i][index].template update<kRateLimit>(bit);
    at = node.child[bit ? 1 : 0];
  }
  return static_cast<std::uint32_t>(~at);
}

template <class Coder>
void SymbolModel::code(Coder& shared_coder, const PointLayout& layout, std::span<std::uint32_t> symbols) {
  Coder coder = std::move(shared_coder);  // a local one can stay in registers
  // Per column: group and range of the latest point in any row above.
  struct Cell {
    std::uint32_t group = 0;
    float range_m = 0;
  };
  std::vector<Cell> above(layout.columns());
  Cell left, left_before;  // the previous points of the row, or the first column's from above
  std::uint32_t row = layout.rows();

  const auto places = layout.raster();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PointLayout::Place& place = places[i];
    Cell* const up = above.data() + place.column;
    if (place.row != row) {
      row = place.row;
      left = left_before = *up;
      if constexpr (Coder::kDecodes) {
        if (coder.overran()) break;
      }
    }
    const std::uint32_t row_class = std::min(row, rows_ - 1);
    const std::array<std::uint32_t, kContexts> context = {
        left.group * kStepClasses + step_class(place.range_m - left.range_m),
        class_of_[left.group] * kGroupClasses + class_of_[left_before.group],
        row_class * kRangeClasses + range_class(place.range_m)};
    const std::uint32_t group = code_group(coder, context, symbols[i] >> low_bits_);
    std::uint32_t low = 1;
    for (int bit = low_bits_; bit-- > 0;) {
      AdaptiveBit* const tree = low_.data() + (std::size_t{group} << low_bits_);
      low = (low << 1) | (coder.code(tree[low], (symbols[i] >> bit) & 1u) ? 1u : 0u);
    }
    symbols[i] = (group << low_bits_) | (low - (1u << low_bits_));
    left_before = left;
    left = {group, place.range_m};
    *up = left;
  }
  shared_coder = std::move(coder);
}

template void SymbolModel::code(BitEncoder&, const PointLayout&, std::span<std::uint32_t>);
template void SymbolModel::code(BitDecoder&, const PointLayout&, std::span<std::uint32_t>);

}  // namespace pointreel
