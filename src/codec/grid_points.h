// The points of a sweep's grid and its strays, in output order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "codec/gridded_geometry.h"
#include "predict/coding_grid.h"
#include "sensor/burst_sort.h"

namespace pointreel {

// Calls take(i, k) for each point i that is no stray: the k-th of the grid. In pieces, on all threads, each
// with its own copy of `take`. `strays`: their places, ascending.
template <class Take>
void for_each_grid_point(std::size_t points, std::span<const std::uint32_t> strays, int threads,
                         const Take& take) {
  for_each_piece(points, threads, [&](std::size_t, std::size_t i, std::size_t end) {
    Take take_here = take;
    auto stray = std::lower_bound(strays.begin(), strays.end(), i);
    std::size_t k = i - static_cast<std::size_t>(stray - strays.begin());
    while (i < end) {
      const std::size_t until = stray == strays.end() ? end : std::min<std::size_t>(end, *stray);
      for (; i < until; ++i, ++k) take_here(i, k);
      if (i < end) {
        ++i;
        ++stray;
      }
    }
  });
}

// `cells`: of the sensor grid, in output order; strays stand between them.
CodedGeometry merged(const CodingGrid& coding, std::span<const std::uint32_t> cells,
                     std::span<const float> range_of_cell_m, std::span<const std::uint32_t> strays,
                     int threads);

FiringPlaces firing_places(const SensorModel& model, const SweepGrid& grid,
                           std::span<const std::uint32_t> cells, const CodedGeometry& geometry);

}  // namespace pointreel
