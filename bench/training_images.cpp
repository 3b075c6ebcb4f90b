#include "training_images.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "codec/sweep_alignment.h"
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

TrainingDrive drive_of(const Folder& files) {
  std::vector<PointCloud> clouds;
  for (const auto& path : files) clouds.push_back(require(read_cloud(path)));
  TrainingDrive drive{model_of(clouds, files.front()), {}};
  SweepAlignment alignment(true);
  for (const PointCloud& cloud : clouds) {
    const GriddedSweep sweep = project(drive.model, cloud);
    const auto range_of_cell_m = ranges_by_cell(sweep);
    const bool is_first = drive.sweeps.empty();
    drive.sweeps.push_back(
        {CodingGrid(drive.model, sweep.grid).image_of(range_of_cell_m, 1), sweep.grid,
         alignment.follow(drive.model, sweep.grid, range_of_cell_m, std::nullopt, is_first)});
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
