#include "training_images.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "codec/measured_grid.h"
#include "motion/registration.h"
#include "pointreel/io.h"
#include "predict/coding_grid.h"
#include "predict/warp.h"
#include "require.h"
#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {
namespace {

using Folder = std::vector<std::filesystem::path>;

std::vector<Folder> folders_of(const std::vector<std::string>& sweeps) {
  std::vector<Folder> folders;
  for (const auto& path : require(expand_inputs(sweeps))) {
    if (folders.empty() || path.parent_path() != folders.back().front().parent_path()) folders.emplace_back();
    folders.back().push_back(path);
  }
  return folders;
}

// As many sweeps as the encoder takes.
SensorModel model_of(const std::vector<PointCloud>& clouds, const std::filesystem::path& first) {
  constexpr std::size_t kSweeps = 8;
  SensorEstimator estimator;
  for (std::size_t i = 0; i < std::min(kSweeps, clouds.size()); ++i) estimator.add(clouds[i]);
  if (!estimator.model()) {
    fmt::print(stderr, "{}: no sensor grid found\n", first.string());
    std::exit(1);
  }
  return *estimator.model();
}

std::optional<SweepMotion> registered(const SensorModel& model, const GriddedSweep& previous,
                                      const GriddedSweep& sweep, const std::optional<SweepMotion>& last,
                                      MotionPerTurn& per_turn) {
  const MeasuredGrid reference(model, previous.grid), current(model, sweep.grid);
  const auto reference_m = ranges_by_cell(previous), current_m = ranges_by_cell(sweep);
  const auto guess = last ? std::optional(last->T_ref_cur) : std::nullopt;
  const double motion_per_turn = per_turn.value();
  const Registration registration =
      register_sweeps(reference.with(reference_m), current.with(current_m), guess, motion_per_turn);
  if (!registration.converged) return std::nullopt;
  per_turn.learn(registration.turning);
  return SweepMotion{registration.T_ref_cur, motion_per_turn};
}

TrainingDrive drive_of(const Folder& files) {
  std::vector<PointCloud> clouds;
  for (const auto& path : files) clouds.push_back(require(read_cloud(path)));
  TrainingDrive drive{model_of(clouds, files.front()), {}};
  GriddedSweep previous;
  std::optional<SweepMotion> motion;
  MotionPerTurn per_turn;
  for (const PointCloud& cloud : clouds) {
    GriddedSweep sweep = project(drive.model, cloud);
    const CodingGrid grid(drive.model, sweep.grid);
    TrainingSweep training{grid.empty_image(), sweep.grid, {}};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (sweep.cell_of_point[i] >= 0) {
        training.image.range_m[grid.image_index(static_cast<std::size_t>(sweep.cell_of_point[i]))] =
            sweep.range_m[i];
      }
    }
    if (!drive.sweeps.empty()) motion = registered(drive.model, previous, sweep, motion, per_turn);
    training.motion = motion;
    drive.sweeps.push_back(std::move(training));
    previous = std::move(sweep);
  }
  return drive;
}

}  // namespace

std::vector<TrainingDrive> training_drives(const std::vector<std::string>& sweeps) {
  std::vector<TrainingDrive> drives;
  for (const Folder& files : folders_of(sweeps)) drives.push_back(drive_of(files));
  return drives;
}

ReferenceImage reference_of(const TrainingDrive& drive, std::size_t i,
                            const std::vector<float>& previous_range_m) {
  GridImage image = drive.sweeps[i - 1].image;
  image.range_m = previous_range_m;
  const ReferenceSweep previous{drive.sweeps[i - 1].grid, std::move(image), {}};
  WarpMemory memory;
  return warp(drive.model, drive.sweeps[i].grid, previous, *drive.sweeps[i].motion, 1, memory);
}

}  // namespace pointreel
