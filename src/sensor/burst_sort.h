// Clouds that their maker sorted by time, though whole bursts of points share one: with C++'s std::sort,
// which leaves equal elements in a sequence of its own.
//
// What was measured column by column comes out of it in pieces, half of them backwards. But the sort moves
// points in the same way whenever the bursts have the same sizes: the encoder undoes it, the decoder does it
// again, and the order costs no more than the sizes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

// For each element of the sorted list, its place in the list before: as std::sort of the GNU C++ library has
// it for elements that come burst after burst already. Integers only.
std::vector<std::uint32_t> places_before_sort(std::span<const std::uint32_t> burst_sizes);

// Brings the points into the sequence before the sort, when a field tells of bursts and the rows then follow
// each other more regularly. Returns the sizes of the bursts; empty: there was no such sort.
std::vector<std::uint32_t> undo_sort(PointCloud& cloud);

// The way back. The sizes must add up to the size of the cloud.
void redo_sort(std::span<const std::uint32_t> burst_sizes, PointCloud& cloud);

// When the points before the sort were measured: column, or rather slot * rows + the place of the laser in
// the firing sequence; -1: not known.
struct FiringPlaces {
  std::vector<std::int32_t> of_point;
  std::int32_t rows = 1;
};

// A tenth of a bit a burst when each takes as many columns as the last one.
std::vector<std::uint8_t> encode_bursts(std::span<const std::uint32_t> burst_sizes,
                                        const FiringPlaces& places);
Result<std::vector<std::uint32_t>> decode_bursts(const FiringPlaces& places,
                                                 std::span<const std::uint8_t> bytes);

}  // namespace pointreel
