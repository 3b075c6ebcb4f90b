// pointreel encode: sweeps to a .reel.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "common/motion_input.h"
#include "common/stopwatch.h"
#include "pointreel/console.h"
#include "pointreel/encode_arguments.h"
#include "pointreel/encode_live.h"
#include "pointreel/encode_report.h"
#include "pointreel/exit_code.h"
#include "pointreel/field_choice.h"
#include "pointreel/io.h"
#include "pointreel/reel.h"
#include "pointreel/reel_output.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

Result<std::vector<Pose>> sweep_poses(const EncodeArguments& arguments,
                                      std::span<const std::filesystem::path> sweeps) {
  if (!arguments.poses.empty()) return sweep_poses_from_file(arguments.poses, sweeps);
  if (!arguments.imu.empty()) return sweep_poses_from_imu(arguments.imu, sweeps);
  return std::vector<Pose>{};
}

// The inputs, one after the other. Several files are read at once: from some formats that takes longer than
// encoding.
class InputSweeps {
 public:
  InputSweeps(const std::vector<std::filesystem::path>& paths, const std::vector<Pose>& poses, int threads)
      : paths_(paths), poses_(poses), threads_(threads) {}

  // None at the end, and when one cannot be read.
  std::optional<PosedSweep> next() {
    if (clouds_.empty()) read_some();
    if (clouds_.empty()) return std::nullopt;
    if (!clouds_.front()) {
      error_ = clouds_.front().error();
      return std::nullopt;
    }
    PosedSweep sweep{*std::move(clouds_.front()), {}};
    if (!poses_.empty()) sweep.T_world_sensor = poses_[read_ - clouds_.size()];
    clouds_.pop_front();
    return sweep;
  }

  const std::optional<Error>& error() const { return error_; }

 private:
  void read_some() {
    clouds_.assign(std::min(static_cast<std::size_t>(threads_), paths_.size() - read_), PointCloud{});
    parallel_for(clouds_.size(), threads_,
                 [&](std::size_t i) { clouds_[i] = read_cloud(paths_[read_ + i]); });
    read_ += clouds_.size();
  }

  const std::vector<std::filesystem::path>& paths_;
  const std::vector<Pose>& poses_;
  int threads_;
  std::deque<Result<PointCloud>> clouds_;  // the next ones
  std::size_t read_ = 0;                   // files
  std::optional<Error> error_;
};

// Encodes until the inputs end or one of them fails; the error of that one, if any, after the packets before
// it have been written.
std::optional<Error> encode_sweeps(Encoder& encoder, ReelWriter& writer,
                                   const std::vector<std::filesystem::path>& inputs,
                                   const std::vector<Pose>& poses, int threads, EncodeTotals& totals) {
  Progress progress("encoding", inputs.size());
  std::optional<Error> fault;
  Stopwatch since_packets;
  double reading_ms = 0;  // since then, where nothing else is done meanwhile
  const bool reads_beside = threads > 1 && encoder.header().on_sensor_grid();
  const auto write = [&](const Encoder::Packets& packets) {
    if (!packets) fault = packets.error();
    if (fault || packets->empty()) return !fault;
    const double ms = since_packets.elapsed_ms() - std::exchange(reading_ms, 0);
    for (const Packet& packet : *packets) {
      if (auto written = writer.write(packet); !written) {
        fault = written.error();
        return false;
      }
      totals.add(packet);
      totals.ms_per_frame.push_back(ms / static_cast<double>(packets->size()));
    }
    progress.advance_to(totals.frames);
    since_packets = Stopwatch();
    return true;
  };
  InputSweeps files(inputs, poses, threads);
  bool first = true;
  const auto next = [&] {
    const Stopwatch start;
    auto sweep = files.next();
    if (!reads_beside) reading_ms += start.elapsed_ms();
    if (sweep && std::exchange(first, false)) {
      for (const Field& field : sweep->cloud.fields) totals.fields.push_back(field.name);
    }
    return sweep;
  };
  encoder.encode_all(next, write);
  if (!fault) write(encoder.finish());
  if (fault) return fault;
  if (auto finished = writer.finish(); !finished) return finished.error();
  return files.error();
}

// The fields that were asked for must be in the first input. An existing output is given up only for a new
// one: not when it is an input itself, nor when there is nothing to encode in the first input.
Result<void> may_begin(const EncodeArguments& arguments, const FieldSelection& fields,
                       const std::vector<std::filesystem::path>& inputs) {
  const bool overwrites = arguments.output != "-" && std::filesystem::exists(arguments.output);
  if (overwrites) {
    for (const auto& input : inputs) {
      std::error_code unknown;
      if (std::filesystem::equivalent(arguments.output, input, unknown)) {
        return Error{ErrorCode::invalid_argument, arguments.output + ": is one of the inputs"};
      }
    }
  }
  if (!overwrites && fields.named.empty()) return {};
  const auto first = read_cloud(inputs.front());
  if (!first) return first.error();
  return require_fields(fields, *first, inputs.front().string());
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
  if (is_live(arguments)) return encode_live(arguments, *options, *encoder);
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

  if (const auto ready = may_begin(arguments, options->mixture.fields, *inputs); !ready) {
    print_error(ready.error());
    return kFailed;
  }

  const Stopwatch start;
  auto output = ReelOutput::open(arguments.output, encoder->header());
  if (!output) {
    print_error(output.error());
    return kFailed;
  }
  ReelWriter& writer = (*output)->writer();
  EncodeTotals totals;
  const std::optional<Error> error =
      encode_sweeps(*encoder, writer, *inputs, *poses, resolve_threads(arguments.threads), totals);
  if (error) print_error(*error);
  if (totals.frames == 0) {
    if (!to_stdout) std::filesystem::remove(arguments.output);
    return kFailed;
  }
  totals.bytes = writer.bytes_written();
  totals.wall_s = start.elapsed_ms() / 1000;
  print_report(totals, encoder->header(), options->mixture.fields, arguments.output, arguments.json);
  if (!error) return kDone;
  print_note(fmt::format("{} holds the {} sweeps before the fault", arguments.output, totals.frames));
  return kDataLoss;
}

}  // namespace

Verb add_encode(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("encode", "Compress sweeps into a .reel");
  auto arguments = std::make_shared<EncodeArguments>();
  add_encode_arguments(*verb, *arguments);
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
