// The distinct keys of a sweep, and keys as indices into them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pointreel {

// Ascending; nothing when there are more than kMaxSymbols.
std::optional<std::vector<std::uint64_t>> distinct_keys(std::span<const std::uint64_t> keys);

// Index of every key in the ascending `alphabet`, which holds them all.
std::vector<std::uint32_t> symbols_of(std::span<const std::uint64_t> keys,
                                      std::span<const std::uint64_t> alphabet);

}  // namespace pointreel
