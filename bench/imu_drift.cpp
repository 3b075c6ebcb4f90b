// imu_drift: how far dead reckoning with an IMU is from the true poses of a drive, sweep by sweep.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <fstream>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/motion_input.h"
#include "common/quality.h"
#include "pointreel/exit_code.h"
#include "pointreel/io.h"
#include "require.h"

namespace pointreel {
namespace {

struct Arguments {
  std::vector<std::string> inputs;
  std::string poses, imu, output;
};

struct PoseError {
  double translation_m = 0, rotation_deg = 0;
};

// Of the estimated motion from sweep `from` to sweep `to`; the two tracks may live in different frames.
PoseError motion_error(std::span<const Pose> estimated, std::span<const Pose> truth, std::size_t from,
                       std::size_t to) {
  const Pose T_from_to = truth[from].inverse() * truth[to];
  const Pose T_from_to_estimated = estimated[from].inverse() * estimated[to];
  const Pose error = T_from_to.inverse() * T_from_to_estimated;
  return {error.translation().norm(), Eigen::AngleAxisd(error.rotation()).angle() * 180 / std::numbers::pi};
}

void write_csv(const std::string& path, std::span<const Pose> estimated, std::span<const Pose> truth,
               std::span<const double> times_s) {
  std::ofstream file(path);
  file << "sweep,time_s,travelled_m,step_translation_error_m,step_rotation_error_deg,drift_translation_m,"
          "drift_rotation_deg\n";
  double travelled_m = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::size_t previous = i == 0 ? 0 : i - 1;
    travelled_m += (truth[i].translation() - truth[previous].translation()).norm();
    const PoseError step = motion_error(estimated, truth, previous, i);
    const PoseError drift = motion_error(estimated, truth, 0, i);
    file << fmt::format("{},{:.6f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f}\n", i, times_s[i], travelled_m,
                        step.translation_m, step.rotation_deg, drift.translation_m, drift.rotation_deg);
  }
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot write");
}

// What the encoder sees of the drift: the motion between the key frame and the ends of its group.
void print_summary(std::span<const Pose> estimated, std::span<const Pose> truth) {
  fmt::print("{:<28}{:>14}{:>14}{:>14}{:>14}\n", "motion over", "median [cm]", "worst [cm]", "median [deg]",
             "worst [deg]");
  for (const std::size_t span : {std::size_t{1}, std::size_t{2}, std::size_t{9}, truth.size() - 1}) {
    if (span == 0 || span >= truth.size()) continue;
    std::vector<double> translation_cm, rotation_deg;
    for (std::size_t i = 0; i + span < truth.size(); ++i) {
      const PoseError error = motion_error(estimated, truth, i, i + span);
      translation_cm.push_back(100 * error.translation_m);
      rotation_deg.push_back(error.rotation_deg);
    }
    const std::string what = span == truth.size() - 1 ? "the whole drive"
                             : span == 1              ? "1 sweep"
                                         : fmt::format("{} sweeps (group of {})", span, 2 * span + 1);
    fmt::print("{:<28}{:>14.2f}{:>14.2f}{:>14.4f}{:>14.4f}\n", what, quantile(translation_cm, 0.5),
               quantile(translation_cm, 1), quantile(rotation_deg, 0.5), quantile(rotation_deg, 1));
  }
}

void run(const Arguments& arguments) {
  const auto sweeps = require(expand_inputs(arguments.inputs));
  auto truth = require(sweep_poses_from_file(arguments.poses, sweeps));
  truth.resize(sweeps.size());
  const auto estimated = require(sweep_poses_from_imu(arguments.imu, sweeps));
  const auto times_s = require(sweep_times(sweeps));
  write_csv(arguments.output, estimated, truth, times_s);
  print_summary(estimated, truth);
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  CLI::App app{"Integrates an IMU recording and compares the poses of the sweeps with the true ones."};
  pointreel::Arguments arguments;
  app.add_option("INPUT", arguments.inputs, "Sweeps (their number and times): files, folders or globs")
      ->required();
  app.add_option("--poses", arguments.poses, "True sensor poses (KITTI or TUM)")->required();
  app.add_option("--imu", arguments.imu, "IMU recording (.csv or a KITTI oxts folder)")->required();
  app.add_option("-o,--output", arguments.output, "The CSV file to write")->required();
  try {
    app.parse(argc, argv);
    pointreel::run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? pointreel::kDone : pointreel::kWrongArguments;
  } catch (const std::exception& error) {
    fmt::print(stderr, "imu_drift: {}\n", error.what());
    return pointreel::kFailed;
  }
  return pointreel::kDone;
}
