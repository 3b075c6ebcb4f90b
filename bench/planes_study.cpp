// planes_study: the sensitivity study of Feng, Liu, Zhu (IROS 2020, section VI-C) on any input, as CSV files.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "pointreel/exit_code.h"
#include "study_series.h"
#include "study_tables.h"
#include "sweep_set.h"

namespace {

struct Arguments {
  std::vector<std::string> inputs;
  std::string poses, imu;
  int threads = 0;
  std::size_t max_sweeps = 0;
  pointreel::StudyOptions study;
};

void add_arguments(CLI::App& app, Arguments& arguments) {
  app.add_option("INPUT", arguments.inputs, "Sweeps: files, folders or globs")->required();
  app.add_option("-o,--output", arguments.study.folder, "Folder for the CSV files; files there are replaced")
      ->required();
  app.add_option("--poses", arguments.poses, "Sensor poses, one per sweep (KITTI) or with times (TUM)");
  app.add_option("--imu", arguments.imu,
                 "IMU recording (.csv or a KITTI oxts folder), for the motion series");
  app.add_option("--threads", arguments.threads, "0: one per processor")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  app.add_option("--repeat", arguments.study.repeats, "Passes of the series about speed; medians are written")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--nearest", arguments.study.nearest_sweeps,
                 "Look for nearest neighbours in this many sweeps, evenly spaced")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--sweeps", arguments.max_sweeps, "Take this many sweeps at most; 0: all")
      ->take_last()  // so that bench/run --sweeps overrules its own
      ->capture_default_str();
}

void run(const Arguments& arguments) {
  using namespace pointreel;
  const SweepSet set = load_sweep_set(arguments.inputs, arguments.poses, arguments.imu, arguments.max_sweeps);
  std::filesystem::create_directories(arguments.study.folder);
  for (const Series& series : study_series(set, arguments.threads))
    write_series(series, set, arguments.study);
  write_speedup(speedup_settings(set, arguments.threads), set, arguments.study);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Method planes against threshold, resolution, group size, tile size and residuals, motion and threads, "
      "one CSV file each."};
  Arguments arguments;
  add_arguments(app, arguments);
  try {
    app.parse(argc, argv);
    run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? pointreel::kDone : pointreel::kWrongArguments;
  } catch (const std::exception& error) {
    fmt::print(stderr, "planes_study: {}\n", error.what());
    return pointreel::kFailed;
  }
  return pointreel::kDone;
}
