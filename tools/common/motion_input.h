// A pose for every input sweep, from a pose file or an IMU recording.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "pointreel/motion.h"
#include "pointreel/result.h"

namespace pointreel {

// KITTI (12 numbers a line) or TUM (8 numbers a line) poses; a line per sweep, or TUM times that cover the
// sweeps'.
Result<std::vector<Pose>> sweep_poses_from_file(const std::filesystem::path& file,
                                                std::span<const std::filesystem::path> sweeps);

// IMU .csv or KITTI oxts folder, integrated. A sample per sweep is taken as such; otherwise sweep times
// decide.
Result<std::vector<Pose>> sweep_poses_from_imu(const std::filesystem::path& imu,
                                               std::span<const std::filesystem::path> sweeps);

// Seconds, one a line, from times.txt beside the sweeps or one folder up; 0.1 s apart from 0 where there is
// none.
Result<std::vector<double>> sweep_times(std::span<const std::filesystem::path> sweeps);

}  // namespace pointreel
