// pointreel info: what is inside a .reel, without decoding it; or, with --sensor, what sensor sweeps come
// from.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/reel_input.h"
#include "pointreel/sensor_report.h"
#include "pointreel/units.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

struct InfoArguments {
  std::vector<std::string> inputs;
  bool sensor = false;
  bool verbose = false;
  bool json = false;
};

struct FrameLine {
  std::uint32_t frame, group, reference_frame;
  FrameKind kind;
  std::uint64_t bytes;
  std::uint32_t points_in, points_out, non_finite;
};

struct Summary {
  std::vector<FrameLine> frames;
  std::uint64_t bytes = 0, points_in = 0, points_out = 0, non_finite = 0, key_frames = 0;
};

Summary summarise(ReelReader& reader) {
  Summary summary;
  while (const auto packet = reader.read_packet()) {
    const std::uint64_t bytes = serialize(*packet).size();
    summary.frames.push_back({packet->frame, packet->group, packet->reference_frame, packet->kind, bytes,
                              packet->points_in, packet->points_out, packet->non_finite});
    summary.bytes += bytes;
    summary.points_in += packet->points_in;
    summary.points_out += packet->points_out;
    summary.non_finite += packet->non_finite;
    summary.key_frames += packet->kind == FrameKind::key;
  }
  return summary;
}

const char* name_of(FrameKind kind) {
  return kind == FrameKind::key ? "K" : "P";
}

const char* name_of(Effort effort) {
  return effort == Effort::fast ? "fast" : effort == Effort::max ? "max" : "balanced";
}

nlohmann::json method_json(const StreamHeader& header) {
  if (header.on_sensor_grid()) {
    nlohmann::json json = {{"method", header.method == Method::mixture ? "mixture" : "planes"},
                           {"max_error_m", header.max_error_m},
                           {"group", header.group},
                           {"effort", name_of(header.effort)},
                           {"bound_kind", "space"}};
    if (header.method == Method::planes) json["grid"] = "sensor";
    return json;
  }
  return {{"method", "planes"},
          {"grid", "uniform"},
          {"threshold_m", header.planes.threshold_m},
          {"azimuth_step_deg", degrees(header.planes.azimuth_step_rad)},
          {"elevation_step_deg", degrees(header.planes.elevation_step_rad)},
          {"tile", header.planes.tile_size},
          {"group", header.planes.group},
          {"residual_step_m", header.planes.residual_mode == ResidualMode::raw_float
                                  ? nlohmann::json("raw")
                                  : nlohmann::json(header.planes.residual_step_m)},
          {"bound_kind", "range"},
          {"order_preserved", false}};
}

nlohmann::json to_json(const Summary& summary, const StreamHeader& header, bool complete, bool verbose) {
  nlohmann::json json = method_json(header);
  json.update({{"bound_m", header.bound_m()},
               {"frames", summary.frames.size()},
               {"key_frames", summary.key_frames},
               {"points_in", summary.points_in},
               {"points_out", summary.points_out},
               {"points_lost", summary.points_in - summary.points_out - summary.non_finite},
               {"points_non_finite", summary.non_finite},
               {"packet_bytes", summary.bytes},
               {"complete", complete}});
  if (verbose) {
    for (const FrameLine& line : summary.frames) {
      json["packets"].push_back({{"frame", line.frame},
                                 {"group", line.group},
                                 {"kind", name_of(line.kind)},
                                 {"reference_frame", line.reference_frame},
                                 {"bytes", line.bytes},
                                 {"points_in", line.points_in},
                                 {"points_out", line.points_out},
                                 {"points_non_finite", line.non_finite}});
    }
  }
  return json;
}

double bits_per_point(std::uint64_t bytes, std::uint64_t points) {
  return points == 0 ? 0 : 8.0 * static_cast<double>(bytes) / static_cast<double>(points);
}

void print_sensor_grid(const Summary& summary, const StreamHeader& header) {
  fmt::print("  method    {}: every point within {:g} m, groups of {}, effort {}\n",
             header.method == Method::mixture ? "mixture" : "planes on the sensor's grid", header.max_error_m,
             header.group, name_of(header.effort));
  fmt::print("  kept      {} points; {} not finite\n", summary.points_out, summary.non_finite);
}

void print_uniform_grid(const Summary& summary, const PlanesOptions& planes) {
  fmt::print("  method    planes: threshold {:g} m, grid {:g} x {:g} deg, tiles {}x{}, groups of {}\n",
             planes.threshold_m, degrees(planes.azimuth_step_rad), degrees(planes.elevation_step_rad),
             planes.tile_size, planes.tile_size, planes.group);
  fmt::print("  residual  {}\n", planes.residual_mode == ResidualMode::raw_float
                                     ? std::string("raw float32")
                                     : fmt::format("steps of {:g} m", planes.residual_step_m));
  fmt::print(
      "  kept      {} points; {} lost to nearer ones in the same cell, {} not finite; order not kept\n",
      summary.points_out, summary.points_in - summary.points_out - summary.non_finite, summary.non_finite);
}

void print_summary(const Summary& summary, const StreamHeader& header, const std::string& name,
                   bool verbose) {
  const bool sensor_grid = header.on_sensor_grid();
  fmt::print("{}: {} sweeps ({} key frames), {} points, {} ({:.3f} bits per point{})\n", name,
             summary.frames.size(), summary.key_frames, summary.points_in,
             format_bytes(static_cast<double>(summary.bytes)),
             bits_per_point(summary.bytes, summary.points_in), sensor_grid ? " with fields" : "");
  if (sensor_grid)
    print_sensor_grid(summary, header);
  else
    print_uniform_grid(summary, header.planes);
  if (!verbose) return;
  fmt::print("\n  {:>7} {:>6} {:>4} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "frame", "group", "kind", "reference",
             "bytes", "points in", "out", "bpp");
  for (const FrameLine& line : summary.frames) {
    fmt::print("  {:>7} {:>6} {:>4} {:>9} {:>9} {:>9} {:>9} {:>7.3f}\n", line.frame, line.group,
               name_of(line.kind), line.reference_frame, line.bytes, line.points_in, line.points_out,
               bits_per_point(line.bytes, line.points_in));
  }
}

int run(const InfoArguments& arguments) {
  if (arguments.sensor) return report_sensor({arguments.inputs, arguments.verbose, arguments.json});
  if (arguments.inputs.size() > 1) {
    print_error({ErrorCode::invalid_argument, "REEL: one at a time (--sensor takes many sweeps)"});
    return kWrongArguments;
  }
  const std::string& reel = arguments.inputs.front();
  auto input = ReelInput::open(reel);
  if (!input) {
    print_error(input.error());
    return kFailed;
  }
  ReelReader& reader = (*input)->reader();
  const Summary summary = summarise(reader);
  if (arguments.json) {
    fmt::print("{}\n", to_json(summary, reader.header(), !reader.fault(), arguments.verbose).dump(2));
  } else {
    print_summary(summary, reader.header(), reel, arguments.verbose);
  }
  if (!reader.fault()) return kDone;
  print_error(*reader.fault());
  return kDataLoss;
}

}  // namespace

Verb add_info(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("info", "Show what a .reel holds, or what sensor sweeps come from");
  auto arguments = std::make_shared<InfoArguments>();
  verb->add_option("REEL", arguments->inputs, "The .reel (- for standard input); with --sensor, sweeps")
      ->required();
  verb->add_flag("--sensor", arguments->sensor,
                 "The sensor that these sweeps show: rows, columns, and points that do not fit");
  verb->add_flag("-v,--verbose", arguments->verbose, "A line per frame; with --sensor, per row");
  verb->add_flag("--json", arguments->json, "JSON on standard output");
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
