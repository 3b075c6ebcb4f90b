// pointreel decode: a .reel to one file per sweep.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/parallel.h"
#include "common/packet_batches.h"
#include "common/stopwatch.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/frame_range.h"
#include "pointreel/io.h"
#include "pointreel/missing_frames.h"
#include "pointreel/reel_input.h"
#include "pointreel/stop_event.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

struct DecodeArguments {
  std::string input;
  std::string output;
  std::string format = "kitti";
  std::string frames;
  int threads = 0;
  bool force = false;
  bool json = false;
};

struct Written {
  explicit Written(const FrameRange& wanted) : missing(wanted.begin) {}
  std::uint64_t frames = 0, points = 0;
  bool lost_some = false;
  MissingFrames missing;
};

class SweepFiles {
 public:
  SweepFiles(std::filesystem::path folder, CloudFormat format, bool force)
      : folder_(std::move(folder)), format_(format), force_(force) {}

  Result<void> write(const DecodedSweep& sweep) const {
    const auto path = folder_ / fmt::format("{:06}{}", sweep.frame, file_extension(format_));
    if (!force_ && std::filesystem::exists(path)) {
      return Error{ErrorCode::io_error, path.string() + ": exists; -f overwrites it"};
    }
    return write_cloud(path, sweep.cloud, format_);
  }

 private:
  std::filesystem::path folder_;
  CloudFormat format_;
  bool force_;
};

// Decodes a batch and writes the wanted sweeps. False when writing failed.
bool decode_batch(Decoder& decoder, std::span<const Packet> batch, const FrameRange& wanted,
                  const SweepFiles& files, int threads, Written& written) {
  const auto sweeps = decoder.decode(batch);
  std::vector<Result<void>> files_written(sweeps.size());
  parallel_for(sweeps.size(), threads, [&](std::size_t i) {
    if (sweeps[i] && wanted.contains(sweeps[i]->frame)) files_written[i] = files.write(*sweeps[i]);
  });
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (!sweeps[i]) {
      print_error(sweeps[i].error());
      written.lost_some = true;
    } else if (!files_written[i]) {
      print_error(files_written[i].error());
      return false;
    } else if (wanted.contains(sweeps[i]->frame)) {
      written.missing.decoded(sweeps[i]->frame);
      ++written.frames;
      written.points += sweeps[i]->cloud.size();
    }
  }
  return true;
}

// All packets. Behind a damaged packet it goes on with the next whole one. False when writing failed.
bool decode_all(ReelReader& reader, bool live, Decoder& decoder, const FrameRange& wanted,
                const SweepFiles& files, int threads, Written& written) {
  PacketBatches batches(reader, threads, live);
  for (bool after_damage = false;; after_damage = true) {
    for (auto batch = batches.next(); !batch.empty(); batch = batches.next()) {
      if (after_damage) print_note(fmt::format("goes on with frame {}", batch.front().frame));
      after_damage = false;
      if (!decode_batch(decoder, batch, wanted, files, threads, written)) return false;
    }
    if (!reader.fault()) return true;
    print_error(*reader.fault());
    written.lost_some = true;
    if (!reader.resume()) return true;
  }
}

// Only the packets that the wanted frames need, found by the index; damaged ones are left out.
Result<std::vector<Packet>> packets_for(ReelReader& reader, const FrameRange& wanted, Written& written) {
  const auto index = reader.index();
  if (!index) return index.error();
  if (index->fault) {
    print_error(*index->fault);
    written.lost_some = true;
  }
  std::map<std::uint32_t, std::uint32_t> reference_of;
  for (const ReelIndexEntry& entry : index->entries) reference_of[entry.frame] = entry.reference_frame;
  std::set<std::uint32_t> needed;
  for (const ReelIndexEntry& entry : index->entries) {
    if (!wanted.contains(entry.frame)) continue;
    // Until what is needed already; where a reference is not in the reel, the decoder says so.
    for (auto at = reference_of.find(entry.frame);
         at != reference_of.end() && needed.insert(at->first).second;)
      at = reference_of.find(at->second);
  }
  std::vector<Packet> packets;
  for (const ReelIndexEntry& entry : index->entries) {
    if (!needed.contains(entry.frame)) continue;
    if (auto found = reader.seek(entry); !found) return found.error();
    auto packet = reader.read_packet();
    if (!packet) {
      print_error(reader.fault().value_or(Error{ErrorCode::corrupt, "the index points at no packet"}));
      written.lost_some = true;
      continue;
    }
    packets.push_back(*std::move(packet));
  }
  return packets;
}

int run(const DecodeArguments& arguments) {
  const auto format = parse_cloud_format(arguments.format);
  const auto wanted =
      arguments.frames.empty() ? Result<FrameRange>(FrameRange{}) : parse_frames(arguments.frames);
  for (const Error* error : {format ? nullptr : &format.error(), wanted ? nullptr : &wanted.error()}) {
    if (error == nullptr) continue;
    print_error(*error);
    return kWrongArguments;
  }
  const bool live = arguments.input == "-";
  // Ctrl-C reaches both ends of a pipe: the first one is left to the sender, which ends the stream.
  std::optional<StopEvent> senders_signals;
  if (live) senders_signals.emplace();
  auto input = ReelInput::open(arguments.input);
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
  std::error_code failed;
  std::filesystem::create_directories(arguments.output, failed);
  if (failed) {
    print_error({ErrorCode::io_error, arguments.output + ": cannot create the folder: " + failed.message()});
    return kFailed;
  }

  const int threads = resolve_threads(arguments.threads);
  const SweepFiles files(arguments.output, *format, arguments.force);
  Written written(*wanted);
  const Stopwatch start;
  if (arguments.frames.empty() || live) {
    if (!decode_all(reader, live, *decoder, *wanted, files, threads, written)) return kFailed;
  } else {
    const auto packets = packets_for(reader, *wanted, written);
    if (!packets) {
      print_error(packets.error());
      return kFailed;
    }
    if (!decode_batch(*decoder, *packets, *wanted, files, threads, written)) return kFailed;
  }
  const double wall_s = start.elapsed_ms() / 1000;

  if (written.frames == 0 && !arguments.frames.empty() && !written.lost_some) {
    print_error({ErrorCode::invalid_argument,
                 fmt::format("--frames: {} has no frame in {}", arguments.input, arguments.frames)});
    return kFailed;
  }
  const auto gaps = written.missing.gaps();
  if (!gaps.empty()) print_error({ErrorCode::corrupt, "missing: frames " + describe_gaps(gaps)});
  const double sweeps_per_second = wall_s > 0 ? static_cast<double>(written.frames) / wall_s : 0;
  if (arguments.json) {
    const nlohmann::json report = {{"frames", written.frames},
                                   {"points", written.points},
                                   {"data_lost", written.lost_some},
                                   {"missing_frames", gaps},  // [first, last] each
                                   {"sweeps_per_second_with_io", sweeps_per_second}};
    fmt::print("{}\n", report.dump(2));
  } else {
    fmt::print("{}: {} sweeps, {} points ({:.1f} sweeps/s with reading and writing)\n", arguments.output,
               written.frames, written.points, sweeps_per_second);
  }
  return written.lost_some ? kDataLoss : kDone;
}

}  // namespace

Verb add_decode(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("decode", "Write the sweeps of a .reel as files");
  auto arguments = std::make_shared<DecodeArguments>();
  verb->add_option("REEL", arguments->input,
                   "The .reel; - for standard input: each sweep is written as its packet comes")
      ->required();
  verb->add_option("-o,--output", arguments->output, "Folder for the sweeps (000000.bin, ...)")->required();
  verb->add_option("--format", arguments->format, "kitti, nuscenes, pcd or ply")->capture_default_str();
  verb->add_option("--frames", arguments->frames, "Only frames A to B - 1, as A:B, A:, :B or A");
  verb->add_option("--threads", arguments->threads, "0: one per processor")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  verb->add_flag("-f,--force", arguments->force, "Overwrite files");
  verb->add_flag("--json", arguments->json, "Report as JSON on standard output");
  return [arguments] { return run(*arguments); };
}

}  // namespace pointreel
