// pointreel simulate: a drive through a made-up street, with true poses and IMU.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>

#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/io.h"
#include "pointreel/simulator.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

struct SimulateArguments {
  std::string output;
  int frames = 20;
  std::string sensor = "hdl-64e";
  std::uint64_t seed = 1;
  bool force = false;
};

Result<void> write_times(const std::filesystem::path& path, const std::vector<double>& times_s) {
  std::ofstream file(path);
  for (const double time_s : times_s) file << fmt::format("{:.6f}\n", time_s);
  file.close();
  if (!file) return Error{ErrorCode::io_error, path.string() + ": cannot write"};
  return {};
}

Result<void> simulate(const SimulateArguments& arguments, const SimulatorOptions& options) {
  const std::filesystem::path folder(arguments.output);
  std::error_code failed;
  std::filesystem::create_directories(folder / "velodyne", failed);
  if (failed)
    return Error{ErrorCode::io_error, arguments.output + ": cannot create the folder: " + failed.message()};
  if (!arguments.force && !std::filesystem::is_empty(folder / "velodyne")) {
    return Error{ErrorCode::io_error, (folder / "velodyne").string() + ": is not empty; -f overwrites"};
  }
  Simulator simulator(options);
  std::vector<Pose> poses;
  std::vector<double> times_s;
  Progress progress("simulating", static_cast<std::size_t>(arguments.frames));
  for (int frame = 0; frame < arguments.frames; ++frame) {
    const SimulatedSweep sweep = simulator.next_sweep();
    const auto path = folder / "velodyne" / fmt::format("{:010}.bin", frame);
    if (auto written = write_cloud(path, sweep.cloud, CloudFormat::kitti); !written) return written;
    poses.push_back(sweep.T_world_sensor);
    times_s.push_back(sweep.time_s);
    progress.advance_to(static_cast<std::size_t>(frame) + 1);
  }
  if (auto written = write_kitti_poses(folder / "poses.txt", poses); !written) return written;
  if (auto written = write_imu_csv(folder / "imu.csv", simulator.imu()); !written) return written;
  return write_times(folder / "times.txt", times_s);
}

int run(const SimulateArguments& arguments) {
  const auto sensor = parse_sensor_kind(arguments.sensor);
  if (!sensor) {
    print_error({sensor.error().code, "--sensor: " + sensor.error().message});
    return kWrongArguments;
  }
  SimulatorOptions options;
  options.sensor = *sensor;
  options.seed = arguments.seed;
  if (const auto done = simulate(arguments, options); !done) {
    print_error(done.error());
    return kFailed;
  }
  fmt::print(
      "{}: {} sweeps in velodyne/, true poses in poses.txt, 100 Hz IMU in imu.csv, sweep times in "
      "times.txt\n",
      arguments.output, arguments.frames);
  return kDone;
}

}  // namespace

Verb add_simulate(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("simulate", "Make a drive: sweeps, true poses, IMU");
  auto arguments = std::make_shared<SimulateArguments>();
  verb->add_option("-o,--output", arguments->output, "Folder to fill")->required();
  verb->add_option("--frames", arguments->frames, "Number of sweeps")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  verb->add_option("--sensor", arguments->sensor, "hdl-64e or vlp-16")->capture_default_str();
  verb->add_option("--seed", arguments->seed, "The same seed makes the same bytes")->capture_default_str();
  verb->add_flag("-f,--force", arguments->force, "Overwrite what is there");
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
