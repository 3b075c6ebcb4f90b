#include "pointreel/encode_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "pointreel/field_choice.h"
#include "pointreel/units.h"

namespace pointreel {
namespace {

// What to do instead of giving the option with the other grid.
std::string_view advice_for(std::string_view option) {
  if (option == "--max-error") return "; the uniform grid has --threshold";
  if (option == "--fields") return "; the uniform grid carries geometry only";
  if (option == "--no-temporal") return "; for the uniform grid, use --group 1";
  if (option == "--threshold") return "; all else has --max-error";
  return "";
}

bool is_uniform(const EncodeArguments& arguments) {
  return arguments.method == "planes" && arguments.grid == "uniform";
}

Result<void> options_fit(const EncodeArguments& arguments) {
  if (arguments.method != "planes" && arguments.grid_option->count() > 0)
    return Error{ErrorCode::invalid_argument, "--grid goes with --method planes only"};
  const bool uniform = is_uniform(arguments);
  for (const CLI::Option* option : uniform ? arguments.sensor_only : arguments.uniform_only) {
    if (option->count() == 0) continue;
    return Error{
        ErrorCode::invalid_argument,
        fmt::format("{} {} --method planes --grid uniform{}", option->get_name(),
                    uniform ? "does not go with" : "goes only with", advice_for(option->get_name()))};
  }
  return {};
}

Result<EncoderOptions> sensor_grid_options(const EncodeArguments& arguments) {
  EncoderOptions options;
  options.method = arguments.method == "planes" ? Method::planes : Method::mixture;
  const auto max_error = parse_length_m(arguments.max_error);
  if (!max_error) return Error{ErrorCode::invalid_argument, "--max-error: " + max_error.error().message};
  options.mixture.max_error_m = *max_error;
  auto fields = parse_field_selection(arguments.fields);
  if (!fields) return Error{ErrorCode::invalid_argument, "--fields: " + fields.error().message};
  options.mixture.fields = *std::move(fields);
  if (arguments.group) options.mixture.group = *arguments.group;
  options.mixture.effort = arguments.effort == "fast"  ? Effort::fast
                           : arguments.effort == "max" ? Effort::max
                                                       : Effort::balanced;
  options.mixture.temporal = !arguments.no_temporal;
  options.mixture.register_sweeps = arguments.motion == "auto";
  return options;
}

Result<EncoderOptions> uniform_grid_options(const EncodeArguments& arguments) {
  EncoderOptions options;
  options.method = Method::planes;
  options.planes.grid = PlaneGrid::uniform;
  const auto threshold = parse_length_m(arguments.threshold);
  if (!threshold) return Error{ErrorCode::invalid_argument, "--threshold: " + threshold.error().message};
  const auto azimuth_step = parse_angle_rad(arguments.azimuth_step);
  if (!azimuth_step)
    return Error{ErrorCode::invalid_argument, "--azimuth-step: " + azimuth_step.error().message};
  const auto elevation_step = parse_angle_rad(arguments.elevation_step);
  if (!elevation_step)
    return Error{ErrorCode::invalid_argument, "--elevation-step: " + elevation_step.error().message};
  options.planes.threshold_m = *threshold;
  options.planes.azimuth_step_rad = *azimuth_step;
  options.planes.elevation_step_rad = *elevation_step;
  options.planes.tile_size = arguments.tile;
  if (arguments.group) options.planes.group = *arguments.group;
  if (arguments.residual_step == "raw") {
    options.planes.residual_mode = ResidualMode::raw_float;
  } else if (arguments.residual_step != "auto") {
    const auto step = parse_length_m(arguments.residual_step);
    if (!step)
      return Error{ErrorCode::invalid_argument,
                   "--residual-step: " + step.error().message + ", or auto, or raw"};
    if (*step == 0)
      return Error{ErrorCode::invalid_argument,
                   "--residual-step: must not be 0 (use raw for no quantisation)"};
    options.planes.residual_step_m = *step;
  }
  return options;
}

Result<void> check_live(const EncodeArguments& arguments) {
  if (arguments.idle_s && !arguments.follow) {
    return Error{ErrorCode::invalid_argument, "--idle goes with --follow only"};
  }
  if (!is_live(arguments)) return {};
  if (arguments.inputs.size() != 1 || (arguments.follow && arguments.inputs.front() == "-")) {
    return Error{ErrorCode::invalid_argument, arguments.follow
                                                  ? "--follow takes one folder"
                                                  : "INPUT: - for standard input goes with no other"};
  }
  if (!arguments.poses.empty() || !arguments.imu.empty()) {
    return Error{ErrorCode::invalid_argument,
                 "--poses and --imu go with files: they must be known for all sweeps beforehand"};
  }
  return {};
}

}  // namespace

bool is_live(const EncodeArguments& arguments) {
  return arguments.follow ||
         std::find(arguments.inputs.begin(), arguments.inputs.end(), "-") != arguments.inputs.end();
}

void add_encode_arguments(CLI::App& verb, EncodeArguments& arguments) {
  verb.add_option(
          "INPUT", arguments.inputs,
          "Sweeps: files, folders or globs (KITTI .bin, nuScenes .pcd.bin, .pcd, .ply); - for standard "
          "input: binary PCD or PLY files one after another, each encoded as it arrives")
      ->required();
  verb.add_option("-o,--output", arguments.output, "The .reel to write; - for standard output")->required();
  verb.add_flag(
      "--follow", arguments.follow,
      "INPUT is a folder to watch: sweeps are encoded as they are completed in it, in the order of their "
      "names, until Ctrl-C");
  verb.add_option("--idle", arguments.idle_s, "Seconds without a new sweep that end --follow, too")
      ->check(CLI::Range(0.0, 1e6));
  verb.add_option("--method", arguments.method,
                  "mixture: ranges, each predicted from many sides; planes: as far as they fit, planes")
      ->check(CLI::IsMember({"mixture", "planes"}))
      ->capture_default_str();
  arguments.grid_option =
      verb.add_option("--grid", arguments.grid,
                      "Of method planes. sensor: every point, within a bound, as with mixture; uniform: the "
                      "paper's, the nearest point of each cell")
          ->check(CLI::IsMember({"sensor", "uniform"}))
          ->capture_default_str();
  verb.add_option(
      "--group", arguments.group,
      "Sweeps that share a key frame, 1 to 255; 1 = each by itself. Default: 10, or 5 with --grid uniform");
  verb.add_option("--threads", arguments.threads,
                  "0: one per processor; the bytes are the same for any number")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  verb.add_flag("-f,--force", arguments.force, "Overwrite the output");
  verb.add_flag("--json", arguments.json, "Report as JSON on standard output");

  const std::string mixture = "Method mixture, and planes with --grid sensor";
  arguments.sensor_only = {
      verb.add_option("--max-error", arguments.max_error,
                      "Distance of any point from where it was at most, 0.5mm to 1m")
          ->capture_default_str()
          ->group(mixture),
      verb.add_option("--fields", arguments.fields,
                      "all, none, or a list of NAME (exact) and NAME:STEP (off by STEP at most); with all in "
                      "the list, the others are kept as well")
          ->capture_default_str()
          ->group(mixture),
      verb.add_option("--effort", arguments.effort,
                      "fast, balanced or max: more work, fewer bits; decoding does the same")
          ->check(CLI::IsMember({"fast", "balanced", "max"}))
          ->capture_default_str()
          ->group(mixture),
      verb.add_flag("--no-temporal", arguments.no_temporal, "Predict no sweep from the one before it")
          ->group(mixture)};

  const std::string planes = "Method planes with --grid uniform";
  arguments.uniform_only = {
      verb.add_option("--threshold", arguments.threshold, "Range error on planes at most, 1mm to 10m")
          ->capture_default_str()
          ->group(planes),
      verb.add_option("--azimuth-step", arguments.azimuth_step, "Width of a range image cell")
          ->capture_default_str()
          ->group(planes),
      verb.add_option("--elevation-step", arguments.elevation_step, "Height of a range image cell")
          ->capture_default_str()
          ->group(planes),
      verb.add_option("--tile", arguments.tile, "Cells per tile side, 2 to 16")
          ->capture_default_str()
          ->group(planes),
      verb.add_option(
              "--residual-step", arguments.residual_step,
              "Range step of cells on no plane: auto (twice the threshold), raw (float32), or a length")
          ->capture_default_str()
          ->group(planes)};

  const std::string group = "Motion";
  verb.add_option("--motion", arguments.motion,
                  "auto: from --poses or --imu; where none is given it is found in the sweeps, but for the "
                  "uniform grid; none: the sensor stands still")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str()
      ->group(group);
  auto* poses =
      verb.add_option("--poses", arguments.poses, "Sensor poses, one per sweep (KITTI), or with times (TUM)")
          ->group(group);
  verb.add_option("--imu", arguments.imu,
                  "IMU recording: .csv (t, ax, ay, az, wx, wy, wz) or a KITTI oxts folder")
      ->excludes(poses)
      ->group(group);
}

Result<EncoderOptions> encoder_options(const EncodeArguments& arguments) {
  if (const auto valid = options_fit(arguments); !valid) return valid.error();
  if (const auto live = check_live(arguments); !live) return live.error();
  if (arguments.motion == "none" && !(arguments.poses.empty() && arguments.imu.empty()))
    return Error{ErrorCode::invalid_argument, "--motion none goes without --poses and --imu"};
  return is_uniform(arguments) ? uniform_grid_options(arguments) : sensor_grid_options(arguments);
}

}  // namespace pointreel
