// SweepPreparation: what comes before a sweep's coding, and needs no sweep coded before it.
//
//   find the sensor -> project -> register, find cells
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "codec/sweep_alignment.h"
#include "codec/sweep_cells.h"
#include "pointreel/codec.h"
#include "sensor/projection.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {

struct PreparedSweep {
  Packet packet;                             // but for payload and statistics
  PointCloud cloud;                          // the finite points; a sort by rows is undone
  std::vector<std::uint32_t> bursts;         // of that sort (sensor/burst_sort.h)
  std::shared_ptr<const SensorModel> model;  // of the group; none: the sweep is not of a known sensor's grid
  bool is_reference = false;                 // the next sweep may be predicted from this one
  // Where there is a model:
  GriddedSweep gridded;
  std::optional<SweepCells> cells;
  std::optional<SweepMotion> motion;  // since the sweep before, which this one is to be predicted from
};

class SweepPreparation {
 public:
  SweepPreparation(const StreamHeader& header, const MixtureOptions& options, int threads);

  // The next sweep. Error: resource_limit or invalid_argument; it is left out then.
  Result<PreparedSweep> prepare(PosedSweep sweep);

 private:
  bool starts_group() const;
  std::optional<GriddedSweep> on_grid(const PointCloud& cloud);
  void name_packet(PreparedSweep& prepared);

  double max_error_m_;
  int group_;
  int threads_;
  GridOptions grid_options_;
  SensorEstimator estimator_;
  std::shared_ptr<const SensorModel> model_;  // of this group
  std::optional<std::uint32_t> model_frame_;  // the frame that brought it
  int model_age_ = 0;                         // sweeps on its grid
  std::optional<SweepGrid> last_grid_;        // of the sweep before
  bool temporal_;
  SweepAlignment alignment_;
  std::uint32_t next_frame_ = 0;
  std::uint32_t next_group_ = 0;
};

}  // namespace pointreel
