// pointreel verify: decodes a .reel and holds every point against its original.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "common/packet_batches.h"
#include "common/stopwatch.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/io.h"
#include "pointreel/reel_input.h"
#include "pointreel/verbs.h"
#include "pointreel/verify_report.h"

namespace pointreel {
namespace {

struct VerifyArguments {
  std::string reel;
  std::vector<std::string> inputs;
  int threads = 0;
  bool json = false;
};

// Fields that the reel does not hold are no work for the encoder that is timed.
void keep_fields_of(const PointCloud& decoded, PointCloud& original) {
  std::erase_if(original.fields,
                [&](const Field& field) { return decoded.find_field(field.name) == nullptr; });
}

// Decodes a reel batch by batch, measures each sweep, and times the encoder on the same sweeps.
class Verifier {
 public:
  Verifier(const StreamHeader& header, const std::vector<std::filesystem::path>& originals, Decoder& decoder,
           int threads)
      : header_(header), originals_(originals), decoder_(decoder), threads_(threads) {}

  // Whole groups, of which so many packets are `decoded_at_once`. Frames may come in any order.
  Result<void> add(std::span<const Packet> batch, std::size_t decoded_at_once) {
    bool temporal = false;
    for (std::size_t first = 0; first < batch.size(); first += decoded_at_once) {
      const auto part = batch.subspan(first, std::min(decoded_at_once, batch.size() - first));
      const auto predicted = add_decoded(part);
      if (!predicted) return predicted.error();
      temporal = temporal || *predicted;
    }
    if (const auto ready = ready_encoder(temporal); !ready) return ready.error();
    if (const auto done = time_encoder(); !done) return done.error();
    for (const Packet& packet : batch) verification_.bytes += serialize(packet).size();
    return {};
  }

  Verification& verification() { return verification_; }

 private:
  // Gives back whether one of them was predicted from the sweep before.
  Result<bool> add_decoded(std::span<const Packet> packets) {
    const Stopwatch start;
    auto sweeps = decoder_.decode(packets);
    const double decode_ms = start.elapsed_ms() / static_cast<double>(packets.size());
    for (const auto& sweep : sweeps) {
      if (!sweep) return sweep.error();
    }
    std::sort(sweeps.begin(), sweeps.end(), [](const auto& a, const auto& b) { return a->frame < b->frame; });
    bool temporal = false;
    for (auto& sweep : sweeps) {
      verification_.decode_ms.push_back(decode_ms);
      temporal = temporal || sweep->temporal;
      if (const auto done = add_sweep(*sweep); !done) return done.error();
      sweep = DecodedSweep{};  // the originals of the batch are held as well
    }
    return temporal;
  }

  Result<void> add_sweep(const DecodedSweep& sweep) {
    if (sweep.frame >= originals_.size()) {
      return Error{ErrorCode::invalid_argument,
                   fmt::format("the reel has a frame {} but only {} originals were given", sweep.frame,
                               originals_.size())};
    }
    const auto& path = originals_[sweep.frame];
    auto original = read_cloud(path);
    if (!original) return original.error();
    const auto pairs = pair_points(header_, *original, sweep);
    if (!pairs) return Error{pairs.error().code, path.string() + ": " + pairs.error().message};
    // Where every point is paired, its nearest neighbour tells nothing more.
    verification_.quality.merge(header_.on_sensor_grid() ? measure_pairs(*original, sweep, *pairs)
                                                         : measure_quality(*original, sweep, *pairs));
    if (sweep.order_kept) {
      const auto compared = compare_fields(*original, sweep, *pairs, verification_.fields);
      if (!compared) return Error{compared.error().code, path.string() + ": " + compared.error().message};
    } else {
      ++verification_.frames_reordered;
    }
    verification_.field_bytes += sweep.field_bytes;
    ++verification_.frames;
    keep_fields_of(sweep.cloud, *original);
    originals_of_batch_.push_back({*std::move(original), {}});
    if (!header_.on_sensor_grid()) originals_of_batch_.back().T_world_sensor = sweep.T_key_sensor;
    return {};
  }

  // On the uniform grid poses are known within a group only, so it starts over with each batch of groups; on
  // the sensor's grid it goes on, which saves looking for the sensor. The header does not say whether sweeps
  // are predicted from the one before: the first batch with one that is does, as a rule the first of all.
  Result<void> ready_encoder(bool temporal) {
    if (encoder_ && header_.on_sensor_grid() && (verification_.temporal || !temporal)) return {};
    verification_.temporal = temporal;
    EncoderOptions options;
    options.method = header_.method;
    options.mixture.max_error_m = header_.max_error_m;
    options.mixture.group = header_.group;
    options.mixture.effort = header_.effort;
    options.mixture.temporal = temporal;
    options.planes = header_.planes;
    auto encoder = Encoder::create(options, Runtime{threads_});
    if (!encoder) return encoder.error();
    encoder_.emplace(*std::move(encoder));
    return {};
  }

  // From one sweep's packet to the next, so that the first and last of a batch take longer with threads. A
  // group on the uniform grid is encoded at its end: its sweeps share the time.
  Result<void> time_encoder() {
    Result<void> good;
    std::vector<double> encode_ms;
    Stopwatch start;
    const auto take = [&](const Encoder::Packets& packets) {
      encode_ms.push_back(start.elapsed_ms());
      start = Stopwatch();
      if (!packets) good = packets.error();
      return static_cast<bool>(good);
    };
    const auto next = [&, i = std::size_t{0}]() mutable -> std::optional<PosedSweep> {
      if (i == originals_of_batch_.size()) return std::nullopt;
      return std::move(originals_of_batch_[i++]);
    };
    encoder_->encode_all(next, take);
    if (good && !header_.on_sensor_grid()) {
      take(encoder_->finish());
      const double sum_ms = std::accumulate(encode_ms.begin(), encode_ms.end(), 0.0);
      encode_ms.assign(originals_of_batch_.size(), sum_ms / static_cast<double>(originals_of_batch_.size()));
    }
    originals_of_batch_.clear();
    verification_.encode_ms.insert(verification_.encode_ms.end(), encode_ms.begin(), encode_ms.end());
    return good;
  }

  const StreamHeader& header_;
  const std::vector<std::filesystem::path>& originals_;
  Decoder& decoder_;
  int threads_;
  std::optional<Encoder> encoder_;
  std::vector<PosedSweep> originals_of_batch_;  // that the encoder is timed with
  Verification verification_;
};

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
  Verifier verifier(reader.header(), *originals, *decoder, arguments.threads);
  Verification& verification = verifier.verification();
  Progress progress("verifying", originals->size());
  PacketBatches batches(reader, resolve_threads(arguments.threads));
  for (auto batch = batches.next_groups(); !batch.empty(); batch = batches.next_groups()) {
    if (const auto done = verifier.add(batch, batches.one_by_one() ? 1 : batch.size()); !done) {
      print_error(done.error());
      return kFailed;
    }
    progress.advance_to(verification.frames);
  }
  verification.frames_missing =
      originals->size() - std::min<std::size_t>(originals->size(), verification.frames);
  if (arguments.json) {
    print_json(verification, reader.header());
  } else {
    print_table(verification, reader.header(), arguments.reel);
  }
  if (reader.fault()) print_error(*reader.fault());
  if (verification.frames_missing > 0) {
    print_error({ErrorCode::truncated, fmt::format("{}: {} of the {} originals are not in it", arguments.reel,
                                                   verification.frames_missing, originals->size())});
  }
  if (!bound_held(verification, reader.header()).value_or(false)) return kFailed;
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
