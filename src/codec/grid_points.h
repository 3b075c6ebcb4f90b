// The points of a sweep's grid and its strays, in output order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/raw_vector.h"
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

// What fields are coded by, once the geometry is: one entry a point, in output order.
struct PointCells {
  std::uint32_t rows = 0, columns = 0;    // of the coding image; 0 when there is none
  RawVector<std::int32_t> cell_of_point;  // in the image; -1: off the grid
  RawVector<float> range_m;               // decoded, along the ray; 0 off the grid
};

PointCells point_cells(const CodingGrid& coding, const OrderedPoints& points,
                       std::span<const float> range_of_cell_m, int threads);
PointCells points_without_cells(std::size_t count);

FiringPlaces firing_places(const SensorModel& model, const SweepGrid& grid, const OrderedPoints& points);

}  // namespace pointreel
