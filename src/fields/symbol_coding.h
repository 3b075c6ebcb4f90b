// Symbols of a small ordered alphabet on the sensor grid: a binary tree of decisions, each predicted from
// several contexts whose predictions are mixed. What intensities need: noisy, but much like their neighbours'
// and different from laser to laser.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/adaptive_models.h"
#include "entropy/bit_mixer.h"
#include "fields/point_layout.h"

namespace pointreel {

inline constexpr std::size_t kMaxSymbols = 4096;

class SymbolModel {
 public:
  // `weights`: of each symbol, at least 1, at most 2^32; they shape the tree so that frequent symbols take
  // few decisions. `rows`: of the layouts to come; more share the last one's contexts.
  SymbolModel(std::span<const std::uint64_t> weights, std::uint32_t rows);

  // One symbol a place of layout.raster(). Coder: BitEncoder or BitDecoder. Stops early when the decoder
  // overruns.
  template <class Coder>
  void code(Coder& coder, const PointLayout& layout, std::span<std::uint32_t> symbols);

 private:
  static constexpr std::size_t kContexts = 3;
  static constexpr std::size_t kMaxGroups = 256;
  static constexpr int kRateLimit = 30;
  static constexpr int kMixingRateShift = 14;
  static constexpr std::int32_t kFirstWeight = 17'000;
  static constexpr Stretch kBias = 256;
  using Mixer = BitMixer<kContexts + 1>;

  // A decision: is the group at or above the split? A child below 0 is the group ~child.
  struct Node {
    std::uint32_t split;
    std::array<std::int32_t, 2> child;  // below, above
    Mixer mixer;
  };

  void grow(std::span<const std::uint64_t> mass_before);
  std::vector<std::uint8_t> quantiles(std::span<const std::uint64_t> mass_before) const;

  template <class Coder>
  std::uint32_t code_group(Coder& coder, const std::array<std::uint32_t, kContexts>& context,
                           std::uint32_t group);

  std::uint32_t groups_, rows_;
  int low_bits_ = 0;  // a symbol is its group and this many bits
  std::int32_t root_ = 0;
  std::vector<Node> nodes_;
  std::vector<std::uint8_t> class_of_;  // of a group; classes are about equally frequent
  std::array<std::vector<CountedBit>, kContexts> bits_;
  std::vector<AdaptiveBit> low_;
};

extern template void SymbolModel::code(BitEncoder&, const PointLayout&, std::span<std::uint32_t>);
extern template void SymbolModel::code(BitDecoder&, const PointLayout&, std::span<std::uint32_t>);

}  // namespace pointreel
