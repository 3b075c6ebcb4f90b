// pointreel verify: decodes a .reel and holds every point against its original.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/packet_batches.h"
#include "common/quality.h"
#include "common/stopwatch.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/io.h"
#include "pointreel/reel_input.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

struct VerifyArguments {
  std::string reel;
  std::vector<std::string> inputs;
  int threads = 0;
  bool json = false;
};

struct Verification {
  SweepQuality quality;
  std::uint64_t frames = 0, bytes = 0;
  std::uint64_t frames_missing = 0;  // originals without a decoded sweep
  std::vector<double> encode_ms, decode_ms;
};

// The threshold is tested on float32 ranges; decoded points are float32, and moved, so allow for their
// rounding, which grows with the range.
constexpr double kRoundingAllowance_m = 1e-4;
constexpr double kRelativeRoundingAllowance = 3e-7;

// Ray error of a kept point: `range_bound_m` of the stream, on every point.
bool bound_held(const Verification& verification, const StreamHeader& header) {
  const double rounding_m =
      kRoundingAllowance_m + kRelativeRoundingAllowance * verification.quality.farthest_m;
  return verification.quality.paired_range.max_m <= header.range_bound_m() + rounding_m;
}

// Decodes one batch, measures it, and times the encoder on the same sweeps. Frames may come in any order.
Result<void> verify_batch(std::span<const Packet> batch, const std::vector<std::filesystem::path>& originals,
                          Decoder& decoder, const StreamHeader& header, int threads,
                          Verification& verification) {
  const Stopwatch start;
  auto sweeps = decoder.decode(batch);
  const double decode_ms = start.elapsed_ms() / static_cast<double>(batch.size());
  for (const auto& sweep : sweeps) {
    if (!sweep) return sweep.error();
  }
  std::sort(sweeps.begin(), sweeps.end(), [](const auto& a, const auto& b) { return a->frame < b->frame; });

  auto encoder = Encoder::create({header.method, header.planes}, Runtime{threads});
  if (!encoder) return encoder.error();
  double encode_ms = 0;
  for (const auto& sweep : sweeps) {
    if (sweep->frame >= originals.size()) {
      return Error{ErrorCode::invalid_argument,
                   fmt::format("the reel has a frame {} but only {} originals were given", sweep->frame,
                               originals.size())};
    }
    const auto& path = originals[sweep->frame];
    auto original = read_cloud(path);
    if (!original) return original.error();
    const auto pairs = pair_points(header, *original, *sweep);
    if (!pairs) return Error{pairs.error().code, path.string() + ": " + pairs.error().message};
    verification.quality.merge(measure_quality(*original, *sweep, *pairs));
    ++verification.frames;
    const Stopwatch encode_start;
    if (const auto packets = encoder->encode(*std::move(original), sweep->T_key_sensor); !packets)
      return packets.error();
    encode_ms += encode_start.elapsed_ms();
  }
  const Stopwatch encode_start;
  if (const auto packets = encoder->finish(); !packets) return packets.error();
  encode_ms = (encode_ms + encode_start.elapsed_ms()) / static_cast<double>(sweeps.size());
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    verification.decode_ms.push_back(decode_ms);
    verification.encode_ms.push_back(encode_ms);
  }
  for (const Packet& packet : batch) verification.bytes += serialize(packet).size();
  return {};
}

nlohmann::json to_json(const ErrorSummary& errors) {
  return {{"count", errors.count},
          {"mean_m", errors.mean_m()},
          {"rms_m", errors.rms_m()},
          {"max_m", errors.max_m}};
}

nlohmann::json to_json(const std::vector<double>& ms) {
  return {{"median", quantile(ms, 0.5)}, {"p95", quantile(ms, 0.95)}};
}

double bits_per_point(const Verification& verification) {
  const auto points = static_cast<double>(verification.quality.points_in);
  return points == 0 ? 0 : 8.0 * static_cast<double>(verification.bytes) / points;
}

nlohmann::json to_json(const Verification& verification, const StreamHeader& header) {
  const SweepQuality& quality = verification.quality;
  const double bpp = bits_per_point(verification);
  return {{"frames", verification.frames},
          {"frames_missing", verification.frames_missing},
          {"points_in", quality.points_in},
          {"points_out", quality.points_out},
          {"points_lost", quality.points_lost},
          {"points_non_finite", quality.non_finite},
          {"pairing", "kept points with their own decoded point; nearest both ways for all points"},
          {"max_error_m", quality.paired.max_m},
          {"mean_error_m", quality.paired.mean_m()},
          {"rmse_m", quality.paired.rms_m()},
          {"range_error", to_json(quality.paired_range)},
          {"angular_rounding", to_json(quality.paired_angular)},
          {"nearest_decoded", to_json(quality.nearest_decoded)},
          {"nearest_original", to_json(quality.nearest_original)},
          {"bound_kind", "range"},
          {"bound_m", header.range_bound_m()},
          {"bound_held", bound_held(verification, header)},
          {"order_preserved", false},
          {"bits_per_point", bpp},
          {"ratio_xyz32", bpp > 0 ? 96 / bpp : 0},
          {"encode_ms", to_json(verification.encode_ms)},
          {"decode_ms", to_json(verification.decode_ms)}};
}

void print_errors(const char* name, const ErrorSummary& errors) {
  fmt::print("  {:<34} {:>10} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, errors.count, errors.mean_m(),
             errors.rms_m(), errors.max_m);
}

void print_table(const Verification& verification, const StreamHeader& header, const std::string& reel) {
  const SweepQuality& quality = verification.quality;
  const double bpp = bits_per_point(verification);
  fmt::print("{}: {} sweeps, {:.3f} bits per point ({:.1f} : 1 against 96-bit x, y, z)\n", reel,
             verification.frames, bpp, bpp > 0 ? 96 / bpp : 0);
  fmt::print(
      "  points  {} in, {} out, {} lost to nearer ones in the same cell, {} not finite; order not kept\n\n",
      quality.points_in, quality.points_out, quality.points_lost, quality.non_finite);
  fmt::print("  {:<34} {:>10} {:>9} {:>9} {:>9}\n", "error in metres", "points", "mean", "rms", "max");
  print_errors("kept points, each to its own", quality.paired);
  print_errors("  along the ray", quality.paired_range);
  print_errors("  rounding to the cell's angles", quality.paired_angular);
  print_errors("all points to the nearest decoded", quality.nearest_decoded);
  print_errors("decoded to the nearest original", quality.nearest_original);
  fmt::print("\n  encode {:.1f} ms, decode {:.1f} ms per sweep (medians)\n",
             quantile(verification.encode_ms, 0.5), quantile(verification.decode_ms, 0.5));
  fmt::print("  range bound {:g} m for kept points: {}\n", header.range_bound_m(),
             bound_held(verification, header) ? "held" : "BROKEN");
}

int run(const VerifyArguments& arguments) {
  const auto originals = expand_inputs(arguments.inputs);
  if (!originals) {
    print_error(originals.error());
    return kFailed;
  }
  auto input = ReelInput::open(arguments.reel);
  if (!input) {
    print_error(input.error());
    return kFailed;
  }
  ReelReader& reader = (*input)->reader();
  auto decoder = Decoder::create(reader.header(), Runtime{arguments.threads});
  if (!decoder) {
    print_error(decoder.error());
    return kFailed;
  }
  Verification verification;
  Progress progress("verifying", originals->size());
  PacketBatches batches(reader);
  for (auto batch = batches.next(); !batch.empty(); batch = batches.next()) {
    if (const auto done =
            verify_batch(batch, *originals, *decoder, reader.header(), arguments.threads, verification);
        !done) {
      print_error(done.error());
      return kFailed;
    }
    progress.advance_to(verification.frames);
  }
  verification.frames_missing =
      originals->size() - std::min<std::size_t>(originals->size(), verification.frames);
  if (arguments.json) {
    fmt::print("{}\n", to_json(verification, reader.header()).dump(2));
  } else {
    print_table(verification, reader.header(), arguments.reel);
  }
  if (reader.fault()) print_error(*reader.fault());
  if (verification.frames_missing > 0) {
    print_error({ErrorCode::truncated, fmt::format("{}: {} of the {} originals are not in it", arguments.reel,
                                                   verification.frames_missing, originals->size())});
  }
  if (!bound_held(verification, reader.header())) return kFailed;
  return reader.fault() || verification.frames_missing > 0 ? kDataLoss : kDone;
}

}  // namespace

Verb add_verify(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("verify", "Decode a .reel and compare every point with its original");
  auto arguments = std::make_shared<VerifyArguments>();
  verb->add_option("REEL", arguments->reel, "The .reel; - for standard input")->required();
  verb->add_option("INPUT", arguments->inputs, "The sweeps it was made from, in the same order")->required();
  verb->add_option("--threads", arguments->threads, "0: one per processor")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  verb->add_flag("--json", arguments->json, "Report as JSON on standard output");
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
