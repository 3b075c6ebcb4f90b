#include "sensor/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pointreel {

SensorDiagnosis diagnose(const SensorModel& model, std::span<const GriddedSweep> sweeps) {
  SensorDiagnosis diagnosis;
  diagnosis.rows = model.rows.size();
  diagnosis.ticks_per_turn = model.ticks_per_turn;
  diagnosis.has_rings = !model.ring_of_row.empty();
  diagnosis.motion_compensated = model.motion_compensated;
  if (!model.rows.empty()) {
    diagnosis.highest_elevation_rad = std::atan(model.rows.front().slope);
    diagnosis.lowest_elevation_rad = std::atan(model.rows.back().slope);
    diagnosis.lowest_offset_m = diagnosis.highest_offset_m = model.rows.front().offset_m;
  }
  for (const RowModel& row : model.rows) {
    diagnosis.lowest_offset_m = std::min(diagnosis.lowest_offset_m, row.offset_m);
    diagnosis.highest_offset_m = std::max(diagnosis.highest_offset_m, row.offset_m);
    diagnosis.largest_side_offset_m = std::max(diagnosis.largest_side_offset_m, std::fabs(row.side_offset_m));
  }
  std::vector<float> deviations;
  std::size_t cells = 0;
  std::size_t columns = 0;
  for (const GriddedSweep& sweep : sweeps) {
    diagnosis.points += sweep.cell_of_point.size();
    columns += sweep.grid.column_count();
    cells += model.rows.size() * sweep.grid.column_count();
    for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
      ++diagnosis.points_by_reason[static_cast<std::size_t>(sweep.stray_reason[i])];
      if (sweep.cell_of_point[i] >= 0) deviations.push_back(sweep.deviation_m[i]);
    }
  }
  if (!sweeps.empty())
    diagnosis.mean_columns = static_cast<double>(columns) / static_cast<double>(sweeps.size());
  if (cells > 0) diagnosis.occupancy = static_cast<double>(deviations.size()) / static_cast<double>(cells);
  if (deviations.empty()) return diagnosis;
  std::sort(deviations.begin(), deviations.end());
  const auto at = [&](double share) {
    return static_cast<double>(
        deviations[static_cast<std::size_t>(share * static_cast<double>(deviations.size() - 1))]);
  };
  diagnosis.deviation = {at(0.5), at(0.95), at(0.99), at(1)};
  return diagnosis;
}

}  // namespace pointreel
