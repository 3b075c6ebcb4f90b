// pointreel-bench: every codec on the same sweeps. Run by `pointreel bench`, so that the tool itself does not
// depend on the libraries of all the codecs.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "codec_measurement.h"
#include "codec_report.h"
#include "codecs/program.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "require.h"
#include "sweep_set.h"

namespace pointreel {
namespace {

struct Arguments {
  std::vector<std::string> inputs;
  std::vector<std::string> codecs;
  std::string poses;
  std::string plots;
  std::size_t max_sweeps = 0;
  BenchSettings settings;
  bool json = false;
  bool list = false;
};

// Codecs differ in what they do with points that have no place; none is given any.
std::size_t drop_non_finite(SweepSet& set) {
  std::size_t dropped = 0;
  for (PointCloud& sweep : set.sweeps)
    dropped += std::erase_if(sweep.positions, [](const Point3f& p) { return !is_finite(p); });
  set.points -= dropped;
  return dropped;
}

Result<void> draw(const std::vector<CodecMeasurement>& measurements, const Arguments& arguments) {
  const std::filesystem::path folder(arguments.plots);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  const std::filesystem::path path = folder / "codecs.jsonl";
  std::ofstream file(path);
  for (const CodecMeasurement& measurement : measurements)
    file << to_json_line(measurement, arguments.settings) << '\n';
  file.close();
  if (!file) return Error{ErrorCode::io_error, path.string() + ": cannot write"};
  // Debian's Python is the one that has Debian's Matplotlib.
  const auto drawn = run_program("/usr/bin/python3", {POINTREEL_PLOT_SCRIPT, folder.string()});
  if (!drawn) {
    return Error{ErrorCode::unsupported,
                 folder.string() + ": not drawn, " POINTREEL_PLOT_SCRIPT " needs python3-matplotlib"};
  }
  return {};
}

int list_codecs() {
  for (const CodecFamily& family : codec_families()) {
    const auto codecs = family.settings();
    fmt::print("{:<12} {}\n", family.name,
               codecs ? fmt::format("{} settings", codecs->size()) : "skipped: " + codecs.error().message);
  }
  return kDone;
}

int run(const Arguments& arguments) {
  if (arguments.list) return list_codecs();
  std::map<std::string, std::string> skipped;
  const auto codecs = choose_codecs(arguments.codecs, skipped);
  if (!codecs) {
    print_error(codecs.error());
    return kWrongArguments;
  }
  for (const auto& [name, why] : skipped) print_note(fmt::format("{} skipped: {}", name, why));
  SweepSet set = load_sweep_set(arguments.inputs, arguments.poses, "", arguments.max_sweeps);
  set.poses.resize(std::min(set.poses.size(), set.sweeps.size()));
  if (const std::size_t dropped = drop_non_finite(set); dropped > 0)
    print_note(fmt::format("{} points that are not finite left out", dropped));

  std::vector<CodecMeasurement> measurements;
  {
    Progress progress("measuring", codecs->size() * static_cast<std::size_t>(arguments.settings.repeats));
    measurements = measure_codecs(*codecs, set, arguments.settings,
                                  [&](std::size_t done) { progress.advance_to(done); });
  }
  if (arguments.json) {
    for (const CodecMeasurement& measurement : measurements)
      fmt::print("{}\n", to_json_line(measurement, arguments.settings));
  } else {
    print_codec_table(measurements, arguments.settings);
  }
  if (!arguments.plots.empty()) require(draw(measurements, arguments));
  const bool failed = std::any_of(measurements.begin(), measurements.end(),
                                  [](const auto& measurement) { return !measurement.failures.empty(); });
  return failed ? kDataLoss : kDone;
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  using namespace pointreel;
  // As the tool does, and for the same reason (tools/pointreel/main.cpp).
  mallopt(M_MMAP_THRESHOLD, 1 << 29);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  CLI::App app{"Measure every codec there is on the same sweeps, geometry only", "pointreel bench"};
  Arguments arguments;
  app.add_option("INPUT", arguments.inputs, "Sweeps: files, folders, globs");
  app.add_option("--codecs", arguments.codecs, "Only these, by name, with commas (--list has them)")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--list", arguments.list, "Say which codecs there are, and why some are not");
  app.add_option("--poses", arguments.poses, "Poses (KITTI or TUM), for method planes in groups");
  app.add_option("--sweeps", arguments.max_sweeps, "Only the first N; 0: all")->capture_default_str();
  app.add_option("--repeat", arguments.settings.repeats, "Rounds of all codecs, for the times")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--nearest", arguments.settings.nearest_sweeps,
                 "Sweeps, evenly spaced, whose nearest neighbours are looked for")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--threads", arguments.settings.threads, "For codecs that can use more than one")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--plots", arguments.plots, "Folder for pictures and codecs.jsonl");
  app.add_flag("--json", arguments.json, "A line of JSON for each codec and setting on standard output");
  try {
    app.parse(argc, argv);
    if (arguments.inputs.empty() && !arguments.list) throw CLI::RequiredError("INPUT");
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongArguments;
  } catch (const std::exception& error) {
    print_error({ErrorCode::io_error, error.what()});
    return kFailed;
  }
}
