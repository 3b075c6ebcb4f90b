// pointreel encode: sweeps to a .reel.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/parallel.h"
#include "common/motion_input.h"
#include "common/quality.h"
#include "common/stopwatch.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/io.h"
#include "pointreel/reel.h"
#include "pointreel/units.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

struct EncodeArguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string method = "planes";
  std::string threshold = "0.1";
  std::string azimuth_step = "0.18deg";
  std::string elevation_step = "0.45deg";
  int tile = 4;
  int group = 5;
  std::string residual_step = "auto";
  std::string poses;
  std::string imu;
  int threads = 0;
  bool force = false;
  bool json = false;
};

Result<EncoderOptions> encoder_options(const EncodeArguments& arguments) {
  EncoderOptions options;
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
  options.planes.group = arguments.group;
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

Result<std::vector<Pose>> sweep_poses(const EncodeArguments& arguments,
                                      std::span<const std::filesystem::path> sweeps) {
  if (!arguments.poses.empty()) return sweep_poses_from_file(arguments.poses, sweeps);
  if (!arguments.imu.empty()) return sweep_poses_from_imu(arguments.imu, sweeps);
  return std::vector<Pose>{};
}

struct EncodeTotals {
  std::uint64_t frames = 0, points = 0, points_out = 0, non_finite = 0, bytes = 0;
  FrameStatistics parts;
  std::vector<double> ms_per_frame;
  std::vector<std::string> fields_left_out;
  double wall_s = 0;

  void add(const Packet& packet) {
    ++frames;
    points += packet.points_in;
    points_out += packet.points_out;
    non_finite += packet.non_finite;
    parts.occupancy_bits += packet.statistics.occupancy_bits;
    parts.plane_bits += packet.statistics.plane_bits;
    parts.residual_bits += packet.statistics.residual_bits;
    parts.spatial_cells += packet.statistics.spatial_cells;
    parts.temporal_cells += packet.statistics.temporal_cells;
    parts.unfit_cells += packet.statistics.unfit_cells;
    parts.runs += packet.statistics.runs;
  }
  double per_point(double bits) const { return points == 0 ? 0 : bits / static_cast<double>(points); }
  double bits() const { return 8.0 * static_cast<double>(bytes); }
  double ratio_xyz32() const {
    return bytes == 0 ? 0 : 12.0 * static_cast<double>(points) / static_cast<double>(bytes);
  }
};

// Encodes until the inputs end or one of them fails; the error of that one, if any, after the packets before
// it have been written.
std::optional<Error> encode_sweeps(Encoder& encoder, ReelWriter& writer,
                                   const std::vector<std::filesystem::path>& inputs,
                                   const std::vector<Pose>& poses, int threads, EncodeTotals& totals) {
  Progress progress("encoding", inputs.size());
  double pending_ms = 0;
  const auto write = [&](const Result<std::vector<Packet>>& packets) -> std::optional<Error> {
    if (!packets) return packets.error();
    for (const Packet& packet : *packets) {
      if (auto written = writer.write(packet); !written) return written.error();
      totals.add(packet);
      totals.ms_per_frame.push_back(pending_ms / static_cast<double>(packets->size()));
    }
    if (!packets->empty()) pending_ms = 0;
    return {};
  };
  // As many files at once as there are threads: reading takes about as long as a tenth of encoding.
  const auto readers = static_cast<std::size_t>(threads);
  std::optional<Error> input_error;
  for (std::size_t begin = 0; begin < inputs.size() && !input_error; begin += readers) {
    std::vector<Result<PointCloud>> clouds(std::min(readers, inputs.size() - begin), PointCloud{});
    parallel_for(clouds.size(), threads, [&](std::size_t i) { clouds[i] = read_cloud(inputs[begin + i]); });
    for (std::size_t i = 0; i < clouds.size() && !input_error; ++i) {
      if (!clouds[i]) {
        input_error = clouds[i].error();
        break;
      }
      if (begin + i == 0) {
        for (const Field& field : clouds[i]->fields) totals.fields_left_out.push_back(field.name);
      }
      const Stopwatch start;
      const auto packets =
          encoder.encode(*std::move(clouds[i]), poses.empty() ? std::optional<Pose>{} : poses[begin + i]);
      pending_ms += start.elapsed_ms();
      if (auto error = write(packets)) return error;
      progress.advance_to(begin + i + 1);
    }
  }
  const Stopwatch start;
  const auto packets = encoder.finish();
  pending_ms += start.elapsed_ms();
  if (auto error = write(packets)) return error;
  if (auto finished = writer.finish(); !finished) return finished.error();
  return input_error;
}

// An existing output is given up only for a new one: not when it is an input itself, nor when there is
// nothing to encode in the first input.
Result<void> may_overwrite(const std::filesystem::path& output,
                           const std::vector<std::filesystem::path>& inputs) {
  if (!std::filesystem::exists(output)) return {};
  for (const auto& input : inputs) {
    std::error_code unknown;
    if (std::filesystem::equivalent(output, input, unknown)) {
      return Error{ErrorCode::invalid_argument, output.string() + ": is one of the inputs"};
    }
  }
  const auto first = read_cloud(inputs.front());
  return first ? Result<void>{} : Result<void>(first.error());
}

nlohmann::json to_json(const EncodeTotals& totals, const StreamHeader& header) {
  return {{"frames", totals.frames},
          {"points", totals.points},
          {"points_kept", totals.points_out},
          {"points_lost", totals.points - totals.points_out - totals.non_finite},
          {"points_non_finite", totals.non_finite},
          {"bytes", totals.bytes},
          {"bits_per_point", totals.per_point(totals.bits())},
          {"ratio_xyz32", totals.ratio_xyz32()},
          {"ms_per_frame",
           {{"median", quantile(totals.ms_per_frame, 0.5)}, {"p95", quantile(totals.ms_per_frame, 0.95)}}},
          {"sweeps_per_second_with_io",
           totals.wall_s > 0 ? static_cast<double>(totals.frames) / totals.wall_s : 0},
          {"bits_by_part",
           {{"occupancy", totals.parts.occupancy_bits},
            {"planes", totals.parts.plane_bits},
            {"residual", totals.parts.residual_bits},
            {"container", totals.bits() - totals.parts.occupancy_bits - totals.parts.plane_bits -
                              totals.parts.residual_bits}}},
          {"cells",
           {{"spatial", totals.parts.spatial_cells},
            {"temporal", totals.parts.temporal_cells},
            {"unfit", totals.parts.unfit_cells}}},
          {"plane_runs", totals.parts.runs},
          {"range_bound_m", header.range_bound_m()},
          {"fields_left_out", totals.fields_left_out}};
}

void print_summary(const EncodeTotals& totals, const StreamHeader& header, const std::string& output) {
  // With the reel itself on standard output, the summary goes to the other stream.
  std::FILE* out = output == "-" ? stderr : stdout;
  const double cells = std::max(1.0, static_cast<double>(totals.points_out));
  fmt::print(out,
             "{}: {} sweeps, {} points -> {} ({:.3f} bits per point, {:.1f} : 1 against 96-bit x, y, z)\n",
             output, totals.frames, totals.points, format_bytes(static_cast<double>(totals.bytes)),
             totals.per_point(totals.bits()), totals.ratio_xyz32());
  fmt::print(out, "  bits per point  occupancy {:.3f}, planes {:.3f}, residual map {:.3f}\n",
             totals.per_point(totals.parts.occupancy_bits), totals.per_point(totals.parts.plane_bits),
             totals.per_point(totals.parts.residual_bits));
  fmt::print(out, "  cells           {:.1f} % on own planes, {:.1f} % on the key frame's, {:.1f} % unfit\n",
             100 * totals.parts.spatial_cells / cells, 100 * totals.parts.temporal_cells / cells,
             100 * totals.parts.unfit_cells / cells);
  fmt::print(out, "  points          {} kept, {} lost to nearer ones in the same cell, {} not finite\n",
             totals.points_out, totals.points - totals.points_out - totals.non_finite, totals.non_finite);
  fmt::print(out, "  range error     at most {:g} m for kept points, plus rounding to the cells' angles\n",
             header.range_bound_m());
  fmt::print(out,
             "  time            {:.1f} ms per sweep (median), {:.1f} sweeps/s with reading and writing\n",
             quantile(totals.ms_per_frame, 0.5), static_cast<double>(totals.frames) / totals.wall_s);
  if (!totals.fields_left_out.empty()) {
    fmt::print(out, "  left out        {} (method planes carries geometry only)\n",
               fmt::join(totals.fields_left_out, ", "));
  }
}

int run(const EncodeArguments& arguments) {
  const auto options = encoder_options(arguments);
  if (!options) {
    print_error(options.error());
    return kWrongArguments;
  }
  auto encoder = Encoder::create(*options, Runtime{arguments.threads});
  if (!encoder) {
    print_error({encoder.error().code, "--" + encoder.error().message});
    return kWrongArguments;
  }
  const bool to_stdout = arguments.output == "-";
  if (to_stdout && arguments.json) {
    print_error({ErrorCode::invalid_argument, "--json and -o - both want standard output"});
    return kWrongArguments;
  }
  if (!to_stdout && !arguments.force && std::filesystem::exists(arguments.output)) {
    print_error({ErrorCode::invalid_argument, arguments.output + ": exists; -f overwrites it"});
    return kFailed;
  }
  const auto inputs = expand_inputs(arguments.inputs);
  if (!inputs) {
    print_error(inputs.error());
    return kFailed;
  }
  const auto poses = sweep_poses(arguments, *inputs);
  if (!poses) {
    print_error(poses.error());
    return kFailed;
  }

  const Stopwatch start;
  std::ofstream file;
  if (!to_stdout) {
    if (const auto safe = may_overwrite(arguments.output, *inputs); !safe) {
      print_error(safe.error());
      return kFailed;
    }
    file.open(arguments.output, std::ios::binary);
    if (!file) {
      print_error({ErrorCode::io_error, arguments.output + ": cannot open for writing"});
      return kFailed;
    }
  }
  auto writer = ReelWriter::create(to_stdout ? std::cout : file, encoder->header());
  EncodeTotals totals;
  const std::optional<Error> error =
      writer ? encode_sweeps(*encoder, *writer, *inputs, *poses, resolve_threads(arguments.threads), totals)
             : std::optional(writer.error());
  if (error) print_error(*error);
  if (totals.frames == 0) {
    if (!to_stdout) std::filesystem::remove(arguments.output);
    return kFailed;
  }
  totals.bytes = writer->bytes_written();
  totals.wall_s = start.elapsed_ms() / 1000;
  if (arguments.json) {
    fmt::print("{}\n", to_json(totals, encoder->header()).dump(2));
  } else {
    print_summary(totals, encoder->header(), arguments.output);
  }
  if (!error) return kDone;
  print_note(fmt::format("{} holds the {} sweeps before the fault", arguments.output, totals.frames));
  return kDataLoss;
}

}  // namespace

Verb add_encode(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("encode", "Compress sweeps into a .reel");
  auto arguments = std::make_shared<EncodeArguments>();
  verb->add_option("INPUT", arguments->inputs,
                   "Sweeps: files, folders or globs (KITTI .bin, nuScenes .pcd.bin, .pcd, .ply)")
      ->required();
  verb->add_option("-o,--output", arguments->output, "The .reel to write; - for standard output")->required();
  verb->add_option("--method", arguments->method, "Compression method")
      ->check(CLI::IsMember({"planes"}))
      ->capture_default_str();
  verb->add_option("--threshold", arguments->threshold, "Range error on planes at most, 1mm to 10m")
      ->capture_default_str();
  verb->add_option("--azimuth-step", arguments->azimuth_step, "Width of a range image cell")
      ->capture_default_str();
  verb->add_option("--elevation-step", arguments->elevation_step, "Height of a range image cell")
      ->capture_default_str();
  verb->add_option("--tile", arguments->tile, "Cells per tile side, 2 to 16")->capture_default_str();
  verb->add_option("--group", arguments->group, "Sweeps that share a key frame, 1 to 255; 1 = each by itself")
      ->capture_default_str();
  verb->add_option("--residual-step", arguments->residual_step,
                   "Range step of cells on no plane: auto (twice the threshold), raw (float32), or a length")
      ->capture_default_str();
  auto* poses = verb->add_option("--poses", arguments->poses,
                                 "Sensor poses, one per sweep (KITTI), or with times (TUM)");
  verb->add_option("--imu", arguments->imu,
                   "IMU recording: .csv (t, ax, ay, az, wx, wy, wz) or a KITTI oxts folder")
      ->excludes(poses);
  verb->add_option("--threads", arguments->threads,
                   "0: one per processor; the bytes are the same for any number")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  verb->add_flag("-f,--force", arguments->force, "Overwrite the output");
  verb->add_flag("--json", arguments->json, "Report as JSON on standard output");
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
