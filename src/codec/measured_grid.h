// MeasuredGrid: a sweep on its sensor's grid as registration takes it: rays without motion compensation.
#pragma once

#include <span>
#include <vector>

#include "base/trigonometry.h"
#include "motion/range_grid.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

class MeasuredGrid {
 public:
  MeasuredGrid(const SensorModel& model, const SweepGrid& grid) {
    rows_.reserve(model.row_count());
    for (const RowModel& row : model.rows) {
      rows_.push_back({row.slope, row.offset_m, row.azimuth_rad, row.side_offset_m});
    }
    column_azimuth_rad_.reserve(grid.column_count());
    for (const std::uint32_t tick : grid.column_tick) {
      column_azimuth_rad_.push_back(static_cast<double>(tick % grid.ticks_per_turn) / grid.ticks_per_turn *
                                    kTurn);
    }
  }

  // Ranges by cell of the sensor grid, row * columns + column; 0: no return. A view of both.
  RangeGrid with(std::span<const float> range_m) const { return {rows_, column_azimuth_rad_, range_m}; }

 private:
  std::vector<GridRow> rows_;
  std::vector<double> column_azimuth_rad_;
};

}  // namespace pointreel
