// pointreel planes: the planes of a .reel's sweeps, without decoding their points.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/frame_range.h"
#include "pointreel/planes_output.h"
#include "pointreel/reel_input.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

struct PlanesArguments {
  std::string reel, output, frames;
  bool force = false;
};

int run(const PlanesArguments& arguments) {
  FrameRange wanted;
  if (!arguments.frames.empty()) {
    const auto range = parse_frames(arguments.frames);
    if (!range) {
      print_error(range.error());
      return kWrongArguments;
    }
    wanted = *range;
  }
  const std::filesystem::path output(arguments.output);
  if (output.extension() != ".json" && output.extension() != ".ply") {
    print_error(
        {ErrorCode::invalid_argument, "-o: " + arguments.output + " ends neither in .json nor in .ply"});
    return kWrongArguments;
  }
  if (!arguments.force && std::filesystem::exists(output)) {
    print_error({ErrorCode::invalid_argument, arguments.output + ": exists; -f overwrites it"});
    return kFailed;
  }
  auto input = ReelInput::open(arguments.reel);
  if (!input) {
    print_error(input.error());
    return kFailed;
  }
  ReelReader& reader = (*input)->reader();
  if (reader.header().method != Method::planes || !reader.header().on_sensor_grid()) {
    print_error({ErrorCode::unsupported,
                 arguments.reel + ": only --method planes --grid sensor keeps planes to be handed out"});
    return kFailed;
  }
  auto decoder = Decoder::create(reader.header());
  if (!decoder) {
    print_error(decoder.error());
    return kFailed;
  }
  std::vector<SweepPlanes> sweeps;
  std::size_t planes = 0;
  bool lost_some = false;
  while (const auto packet = reader.read_packet()) {
    auto decoded = decoder->decode_planes({&*packet, 1});
    if (!decoded.front()) {
      print_error(decoded.front().error());
      lost_some = true;
    } else if (wanted.contains(packet->frame)) {
      planes += decoded.front()->planes.size();
      sweeps.push_back(*std::move(decoded.front()));
    }
  }
  if (reader.fault()) print_error(*reader.fault());
  if (sweeps.empty()) {
    print_error({ErrorCode::invalid_argument, arguments.reel + ": no sweep to take planes from"});
    return kFailed;
  }
  if (const auto written = write_planes(output, sweeps); !written) {
    print_error(written.error());
    return kFailed;
  }
  fmt::print("{}: {} planes of {} sweeps\n", arguments.output, planes, sweeps.size());
  return lost_some || reader.fault() ? kDataLoss : kDone;
}

}  // namespace

Verb add_planes(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("planes", "Write the planes of a .reel of method planes");
  auto arguments = std::make_shared<PlanesArguments>();
  verb->add_option("REEL", arguments->reel, "The .reel; - for standard input")->required();
  verb->add_option("-o,--output", arguments->output,
                   "The .json or .ply to write. In each sweep's own coordinates, as measured")
      ->required();
  verb->add_option("--frames", arguments->frames, "A:B: sweeps from A on, up to B (not included)");
  verb->add_flag("-f,--force", arguments->force, "Overwrite the output");
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
