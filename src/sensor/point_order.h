// The order of a sweep's points on its grid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/order_moves.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// By cell, row * columns + column: the ranges of a sweep's points, 0 where there is none, and which are not
// 0.
std::vector<float> ranges_by_cell(const GriddedSweep& sweep);
std::vector<std::uint8_t> occupied_cells(std::span<const float> range_of_cell_m);

// The occupied cells (row * column_count + column) in the order of the points, but for the moved ones
// (order_moves.h). `occupied`: per cell, 0 or 1. `range_m`: per cell, as decoded; only row_azimuth looks at
// it, and only where occupied. Order none: rows from top to bottom. Deterministic.
std::vector<std::uint32_t> cells_in_order(std::span<const std::uint8_t> occupied,
                                          std::span<const float> range_m, const SensorModel& model,
                                          const SweepGrid& grid, int threads = 1);

// When the cells of a column-major cloud were measured: slot * rows + place in the row sequence. -1 where the
// order is another one.
std::vector<std::int32_t> firing_places_of(const SensorModel& model, const SweepGrid& grid,
                                           std::span<const std::uint32_t> cells);

// The cells of the points in the order of the cloud: what find_moves() compares with cells_in_order().
std::vector<std::uint32_t> cells_of_points(const GriddedSweep& sweep);

// The order that leaves the fewest points to be moved; none when those are more than a fiftieth. A sweep
// whose columns were unwrapped along its points' sequence says so by `firing_descending`, and is
// column-major.
PointOrder find_order(const SensorModel& model, const GriddedSweep& sweep,
                      std::optional<bool> firing_descending);

// The moves that the order of `sweep` leaves, given the image as decoded and cells_of_points(). Where an
// order by rows, taken from the sweep before, leaves more than a few, another one is looked for; where even
// that leaves too many, the order becomes none.
std::vector<OrderMove> settle_order(const SensorModel& model, std::span<const std::uint8_t> occupied,
                                    std::span<const float> range_m, std::span<const std::uint32_t> walk,
                                    GriddedSweep& sweep, int threads);

}  // namespace pointreel
