// registration: what compression does to registration, the paper's first application. Consecutive sweeps are
// registered by PCL, as measured and as decoded by every codec at every rate, and held against the true
// poses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "codec_measurement.h"
#include "drift.h"
#include "pcl_icp.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "require.h"
#include "sweep_set.h"

namespace pointreel {
namespace {

struct Arguments {
  std::vector<std::string> inputs, codecs, without;
  std::string poses, output;
  std::size_t max_sweeps = 0;
  int seeds = 4;
  double voxel_m = 0.5, farthest_m = 1, most_bpp = 8;
  bool poses_at_begin = false, motion_unknown = false;
};

constexpr PclMethod kMethods[] = {PclMethod::point_to_plane, PclMethod::generalised};

const char* name_of(PclMethod method) {
  return method == PclMethod::point_to_plane ? "point-to-plane ICP" : "GICP";
}

// By method, then by seed.
using Drifts = std::map<PclMethod, std::vector<Drift>>;

Drifts drifts_of(const std::vector<PointCloud>& sweeps, const std::vector<Pose>& T_world_sensor,
                 const Arguments& arguments) {
  Drifts drifts;
  for (const PclMethod method : kMethods) {
    for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(arguments.seeds); ++seed) {
      const MotionTrack track =
          pcl_icp_track(sweeps, {arguments.voxel_m, arguments.farthest_m, method, seed});
      drifts[method].push_back(drift_of(track, T_world_sensor));
    }
  }
  return drifts;
}

struct Registered {
  std::string series, settings;
  double bits_per_point;
  Drifts drifts;
};

void write_lines(std::ostream& out, const Registered& registered) {
  for (const auto& [method, by_seed] : registered.drifts) {
    nlohmann::json line = {{"series", registered.series},
                           {"settings", registered.settings},
                           {"bits_per_point", registered.bits_per_point},
                           {"method", name_of(method)},
                           {"path_m", by_seed.front().path_m},
                           {"translation_percent", nlohmann::json::array()},
                           {"rotation_deg_per_100m", nlohmann::json::array()},
                           {"median_step_error_m", nlohmann::json::array()},
                           {"failures", 0}};
    for (const Drift& drift : by_seed) {
      line["translation_percent"].push_back(drift.translation_percent);
      line["rotation_deg_per_100m"].push_back(drift.rotation_deg_per_100m);
      line["median_step_error_m"].push_back(drift.median_step_error_m);
      line["failures"] = line["failures"].get<int>() + drift.failures;
    }
    out << line.dump() << '\n';
  }
}

double bits_per_point(const CodecPass& pass, std::size_t points) {
  std::uint64_t bytes = 0;
  for (const Chunk& chunk : pass.chunks) bytes += chunk.bytes.size();
  return 8.0 * static_cast<double>(bytes) / static_cast<double>(points);
}

// The first sweep takes more than those that are predicted from it, but hardly twice as much.
bool far_too_large(const Codec& codec, const SweepSet& set, const DriveContext& drive, double most_bpp) {
  const CodecPass pass = run_codec(codec, {set.sweeps.front()}, drive);
  return !pass.failure && bits_per_point(pass, set.sweeps.front().size()) > 2 * most_bpp;
}

// None: not wanted, too large, or failed, which is said.
std::optional<Registered> registered(const Codec& codec, const SweepSet& set, const Arguments& arguments) {
  if (std::count(arguments.without.begin(), arguments.without.end(), codec.series()) > 0) return {};
  // As `pointreel bench` gives them to the codecs.
  const DriveContext drive{arguments.motion_unknown ? std::span<const Pose>()
                                                    : std::span<const Pose>(set.poses)};
  if (far_too_large(codec, set, drive, arguments.most_bpp)) return {};
  const CodecPass pass = run_codec(codec, set.sweeps, drive);
  if (pass.failure) {
    print_note(fmt::format("{}, {}: {}", codec.series(), codec.settings(), pass.failure->message));
    return {};
  }
  const double bpp = bits_per_point(pass, set.points);
  if (bpp > arguments.most_bpp) return {};
  return Registered{codec.series(), codec.settings(), bpp, drifts_of(pass.decoded, set.poses, arguments)};
}

void run(const Arguments& arguments) {
  SweepSet set = load_sweep_set(arguments.inputs, arguments.poses, "", arguments.max_sweeps);
  if (arguments.poses_at_begin) set.poses = poses_in_the_middle(set.poses);
  const std::size_t count = std::min(set.sweeps.size(), set.poses.size());
  set.poses.resize(count);
  set.sweeps.resize(count);
  set.points = 0;
  for (const PointCloud& sweep : set.sweeps) set.points += sweep.size();

  std::map<std::string, std::string> skipped;
  const auto codecs = require(choose_codecs(arguments.codecs, skipped));
  for (const auto& [name, why] : skipped) print_note(fmt::format("{} skipped: {}", name, why));

  // A setting is one thread's from encoding to the last registration: neither has to wait for the other's
  // codec.
  std::vector<std::optional<Registered>> results(1 + codecs.size());
  Progress progress("registering", results.size());
  std::mutex counting;
  std::size_t done = 0;
  parallel_for(results.size(), resolve_threads(0), [&](std::size_t job) {
    results[job] = job == 0 ? Registered{"original", "", 96, drifts_of(set.sweeps, set.poses, arguments)}
                            : registered(*codecs[job - 1].codec, set, arguments);
    const std::lock_guard lock(counting);
    progress.advance_to(++done);
  });

  std::ofstream out(arguments.output);
  for (const auto& result : results) {
    if (result) write_lines(out, *result);
  }
  out.close();
  if (!out) throw std::runtime_error(arguments.output + ": cannot write");
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  using namespace pointreel;
  CLI::App app{"Register sweeps as measured and as decoded by every codec, and compare with the true poses"};
  Arguments arguments;
  app.add_option("INPUT", arguments.inputs, "Sweeps: files, folders, globs")->required();
  app.add_option("--poses", arguments.poses, "The true poses (KITTI or TUM)")->required();
  app.add_flag("--poses-at-begin", arguments.poses_at_begin,
               "They are of the begin of each sweep, not of its middle");
  app.add_flag("--motion-unknown", arguments.motion_unknown, "The codecs are not given the true poses");
  app.add_option("-o,--output", arguments.output, "Lines of JSON: one a codec, setting and method")
      ->required();
  app.add_option("--codecs", arguments.codecs, "Only these, by name, with commas")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--without", arguments.without, "Not this series; once for each")->allow_extra_args(false);
  app.add_option("--sweeps", arguments.max_sweeps, "Only the first N; 0: all")->capture_default_str();
  app.add_option("--seeds", arguments.seeds, "Sub-samplings of every sweep")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  app.add_option("--voxel", arguments.voxel_m, "Clouds are thinned to a point per voxel of this many metres")
      ->capture_default_str();
  app.add_option("--farthest", arguments.farthest_m, "Between points that correspond, in metres")
      ->capture_default_str();
  app.add_option("--most-bpp", arguments.most_bpp, "Leaves out settings that need more bits a point")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
    run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongArguments;
  } catch (const std::exception& error) {
    fmt::print(stderr, "registration: {}\n", error.what());
    return kFailed;
  }
  return kDone;
}
