// Sweeps from files as the images that method `mixture` codes, for training its priors and for the ablation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "motion/sweep_motion.h"
#include "predict/grid_image.h"
#include "predict/reference_image.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

struct TrainingSweep {
  GridImage image;
  SweepGrid grid;
  // Since the sweep before in the same folder, by registration; none for the first, or where that fails.
  std::optional<SweepMotion> motion;
};

// Consecutive sweeps of one folder.
struct TrainingDrive {
  SensorModel model;
  std::vector<TrainingSweep> sweeps;
};

// Exits with a message where a file cannot be read or shows no sensor grid.
std::vector<TrainingDrive> training_drives(const std::vector<std::string>& sweeps);

// The sweep before, decoded to `previous_range_m`, as a reference of sweep `i`, which has a pose.
ReferenceImage reference_of(const TrainingDrive& drive, std::size_t i,
                            const std::vector<float>& previous_range_m);

}  // namespace pointreel
