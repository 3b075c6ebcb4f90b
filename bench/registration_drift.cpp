// registration_drift: how far the encoder's own registration drifts from true poses, and how long it takes,
// beside registration by the planes of encoded sweeps and PCL's point-to-plane ICP on the whole clouds. With
// --apart, whether its steps add up to what it finds between sweeps that are farther apart.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "codec/measured_grid.h"
#include "drift.h"
#include "motion/registration.h"
#include "pointreel/codec.h"
#include "pointreel/exit_code.h"
#include "pointreel/simulator.h"
#include "require.h"
#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/sensor_estimator.h"
#include "sweep_set.h"
#ifdef POINTREEL_WITH_PCL
#include "pcl_icp.h"
#endif

namespace pointreel {
namespace {

struct Arguments {
  std::vector<std::string> folders;
  int simulated_sweeps = 0;
  double simulated_mps = 12;
  double reference_bound_m = 0;
  bool with_pcl = true;
  bool apart = false;
};

// A sweep on the grid that the encoder finds.
struct OwnSweep {
  MeasuredGrid measured;
  std::vector<float> range_m;
  RangeGrid grid() const { return measured.with(range_m); }
};

// As a decoder has it when every point must be within the bound; 0: as measured.
OwnSweep decoded(OwnSweep sweep, double bound_m) {
  if (!(bound_m > 0)) return sweep;
  const auto step_m = static_cast<float>(2 * bound_m);
  for (float& range_m : sweep.range_m) {
    if (range_m > 0) range_m = std::max(1.0F, std::round(range_m / step_m)) * step_m;
  }
  return sweep;
}

std::vector<OwnSweep> own_sweeps(const std::vector<PointCloud>& sweeps) {
  std::vector<OwnSweep> own;
  SensorEstimator estimator;
  for (const PointCloud& sweep : sweeps) {
    estimator.add(sweep);
    if (!estimator.model()) throw std::runtime_error("no sensor grid found");
    const GriddedSweep gridded = project(*estimator.model(), sweep);
    own.push_back({MeasuredGrid(*estimator.model(), gridded.grid), ranges_by_cell(gridded)});
  }
  return own;
}

struct OwnTrack {
  MotionTrack steps;
  MotionPerTurn per_turn;  // learnt along the way
};

// Each against the one before; the last motion is the guess.
OwnTrack own_track(const std::vector<OwnSweep>& sweeps, double reference_bound_m) {
  OwnTrack track;
  auto& [steps, per_turn] = track;
  std::optional<Pose> guess;
  for (std::size_t i = 1; i < sweeps.size(); ++i) {
    const OwnSweep reference = decoded(sweeps[i - 1], reference_bound_m);
    const std::clock_t begin = std::clock();
    const Registration found = register_sweeps(reference.grid(), sweeps[i].grid(), guess, per_turn.value());
    steps.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    steps.T_previous_sweep.push_back(found.T_ref_cur);
    per_turn.learn(found.turning);
    guess.reset();
    if (found.converged)
      guess = found.T_ref_cur;
    else
      ++steps.failures;
  }
  return track;
}

// Mean distance of sweeps that are a number of sweeps apart, by single steps and at once.
void print_apart(const std::string& set, const std::vector<OwnSweep>& sweeps, double reference_bound_m) {
  const auto [track, per_turn] = own_track(sweeps, reference_bound_m);
  constexpr std::size_t kFarthest = 5;
  for (std::size_t apart = 2; apart <= kFarthest && apart < sweeps.size(); ++apart) {
    const double share_per_turn = per_turn.value() / static_cast<double>(apart);
    double by_steps_m = 0, at_once_m = 0;
    std::size_t pairs = 0;
    for (std::size_t i = 0; i + apart < sweeps.size(); ++i) {
      Pose by_steps = Pose::Identity();
      for (std::size_t k = i; k < i + apart; ++k) by_steps = by_steps * track.T_previous_sweep[k];
      const OwnSweep reference = decoded(sweeps[i], reference_bound_m);
      const Registration found =
          register_sweeps(reference.grid(), sweeps[i + apart].grid(), by_steps, share_per_turn);
      if (!found.converged) continue;
      ++pairs;
      by_steps_m += by_steps.translation().norm();
      at_once_m += found.T_ref_cur.translation().norm();
    }
    if (pairs == 0) continue;
    const auto count = static_cast<double>(pairs);
    fmt::print("{}, {} apart: {:.4f} m by steps, {:.4f} m at once, {:+.1f} mm ({} pairs)\n", set, apart,
               by_steps_m / count, at_once_m / count, 1000 * (at_once_m - by_steps_m) / count, pairs);
  }
}

// From the planes of the encoded sweeps alone.
MotionTrack planes_track(const std::vector<PointCloud>& sweeps, double bound_m) {
  EncoderOptions options;
  options.method = Method::planes;
  options.mixture.max_error_m = bound_m;
  options.mixture.effort = Effort::fast;
  options.mixture.group = 255;
  options.mixture.fields.all_others = false;
  Encoder encoder = require(Encoder::create(options, Runtime{1}));
  Decoder decoder = require(Decoder::create(encoder.header(), Runtime{1}));
  MotionTrack track;
  std::optional<SweepPlanes> previous;
  std::optional<Pose> guess;
  for (const PointCloud& sweep : sweeps) {
    const auto packets = require(encoder.encode(sweep));
    SweepPlanes planes = require(decoder.decode_planes(packets).front());
    if (previous) {
      const std::clock_t begin = std::clock();
      const auto found = register_planes(*previous, planes, guess);
      track.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
      if (found)
        guess = found->T_ref_cur;
      else
        ++track.failures;
      track.T_previous_sweep.push_back(guess.value_or(Pose::Identity()));
    }
    previous = std::move(planes);
  }
  return track;
}

void print_row(const std::string& set, const std::string& method, const MotionTrack& track,
               const std::vector<Pose>& truth) {
  const Drift drift = drift_of(track, truth);
  fmt::print("| {} | {} | {:.1f} | {:.2f} | {:.2f} | {:.2f} / {:.2f} | {:.2f} | {} |\n", set, method,
             drift.path_m, drift.translation_percent, drift.rotation_deg_per_100m,
             100 * drift.median_step_error_m, 100 * drift.largest_step_error_m, drift.median_cpu_ms,
             drift.failures);
}

void compare(const std::string& name, const std::vector<PointCloud>& sweeps, const std::vector<Pose>& truth,
             const Arguments& arguments) {
  const auto own = own_sweeps(sweeps);
  if (arguments.apart) {
    print_apart(name, own, arguments.reference_bound_m);
    return;
  }
  print_row(name, "own", own_track(own, arguments.reference_bound_m).steps, truth);
  for (const double bound_m : {0.02, 0.05, 0.1})
    print_row(name, fmt::format("planes, {:g} cm", 100 * bound_m), planes_track(sweeps, bound_m), truth);
#ifdef POINTREEL_WITH_PCL
  if (!arguments.with_pcl) return;
  for (const PclIcpSettings& settings :
       {PclIcpSettings{.voxel_m = 0.3, .farthest_m = 1}, PclIcpSettings{.voxel_m = 0.1, .farthest_m = 0.5}}) {
    print_row(name, fmt::format("PCL, {} m voxels", settings.voxel_m), pcl_icp_track(sweeps, settings),
              truth);
  }
#endif
}

void compare_simulated(const Arguments& arguments) {
  SimulatorOptions options;
  options.cruise_speed_mps = arguments.simulated_mps;
  require(validate(options));
  Simulator simulator(options);
  std::vector<PointCloud> sweeps;
  std::vector<Pose> T_world_begin;
  for (int i = 0; i <= arguments.simulated_sweeps; ++i) {
    SimulatedSweep sweep = simulator.next_sweep();
    T_world_begin.push_back(sweep.T_world_sensor);
    if (i < arguments.simulated_sweeps) sweeps.push_back(std::move(sweep.cloud));
  }
  compare(fmt::format("simulated, {} m/s", arguments.simulated_mps), sweeps,
          poses_in_the_middle(T_world_begin), arguments);
}

void run(const Arguments& arguments) {
  if (!arguments.apart)
    fmt::print(
        "| drive | method | path m | translation % | rotation deg/100 m | step error cm, median / worst | "
        "CPU ms per sweep | failures |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& folder : arguments.folders) {
    const std::filesystem::path path(folder);
    SweepSet set = load_sweep_set({folder}, (path / "poses.txt").string(), "", 0);
    set.poses.resize(set.sweeps.size());
    compare(path.filename().string(), set.sweeps, set.poses, arguments);
  }
  if (arguments.simulated_sweeps > 1) compare_simulated(arguments);
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  CLI::App app{"Registers each sweep of a drive against the one before and compares with the true poses."};
  pointreel::Arguments arguments;
  app.add_option("FOLDER", arguments.folders, "Folders of sweeps, with poses.txt (KITTI)");
  app.add_option("--simulated", arguments.simulated_sweeps, "Sweeps of a simulated drive to do as well");
  app.add_option("--speed", arguments.simulated_mps, "Its cruising speed in m/s")->capture_default_str();
  app.add_option("--reference-bound", arguments.reference_bound_m,
                 "Registers against sweeps decoded with this bound in metres");
  app.add_flag("--apart", arguments.apart, "Distances of sweeps up to five apart, by steps and at once");
  app.add_flag("!--no-pcl", arguments.with_pcl, "Without PCL");
  try {
    app.parse(argc, argv);
    pointreel::run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? pointreel::kDone : pointreel::kWrongArguments;
  } catch (const std::exception& error) {
    fmt::print(stderr, "registration_drift: {}\n", error.what());
    return pointreel::kFailed;
  }
  return pointreel::kDone;
}
