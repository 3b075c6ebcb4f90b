#include "codec_measurement.h"

#include <algorithm>
#include <set>

#include "base/parallel.h"
#include "common/stopwatch.h"
#include "peak_memory.h"

namespace pointreel {
namespace {

// Shares the time since the last output among the sweeps that came out.
void share_time(double& pending_ms, std::size_t sweeps, std::vector<double>& ms_of_sweep) {
  if (sweeps == 0) return;
  ms_of_sweep.insert(ms_of_sweep.end(), sweeps, pending_ms / static_cast<double>(sweeps));
  pending_ms = 0;
}

void encode_all(const Codec& codec, const std::vector<PointCloud>& sweeps, const DriveContext& drive,
                CodecPass& pass) {
  const auto encoder = codec.encoder(drive);
  double pending_ms = 0;
  const auto add = [&](const Result<std::vector<Chunk>>& chunks) {
    if (!chunks) {
      pass.failure = chunks.error();
      return;
    }
    std::size_t done = 0;
    for (const Chunk& chunk : *chunks) done += chunk.sweeps;
    share_time(pending_ms, done, pass.encode_ms);
    pass.chunks.insert(pass.chunks.end(), chunks->begin(), chunks->end());
  };
  for (std::size_t i = 0; i <= sweeps.size() && !pass.failure; ++i) {
    const Stopwatch start;
    const auto chunks = i < sweeps.size() ? encoder->encode(sweeps[i]) : encoder->finish();
    pending_ms += start.elapsed_ms();
    add(chunks);
  }
  pass.program_peak_kib = std::max(pass.program_peak_kib, encoder->program_peak_kib());
}

void decode_all(const Codec& codec, const DriveContext& drive, CodecPass& pass) {
  const auto decoder = codec.decoder(drive);
  double pending_ms = 0;
  for (std::size_t i = 0; i <= pass.chunks.size() && !pass.failure; ++i) {
    const Stopwatch start;
    auto clouds = i < pass.chunks.size() ? decoder->decode(pass.chunks[i]) : decoder->finish();
    pending_ms += start.elapsed_ms();
    if (!clouds) {
      pass.failure = clouds.error();
      return;
    }
    share_time(pending_ms, clouds->size(), pass.decode_ms);
    for (PointCloud& cloud : *clouds) pass.decoded.push_back(std::move(cloud));
  }
  pass.order_kept = decoder->order_kept();
  pass.program_peak_kib = std::max(pass.program_peak_kib, decoder->program_peak_kib());
}

void append(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

// What does not change from round to round.
void describe(const NamedCodec& named, const CodecPass& pass, const SweepSet& set, const DriveContext& drive,
              CodecMeasurement& measurement) {
  measurement.family = named.family;
  measurement.series = named.codec->series();
  measurement.settings = named.codec->settings();
  measurement.threads = named.codec->threads(drive);
  measurement.fields_possible = named.codec->carries_fields();
  measurement.sweeps = set.sweeps.size();
  measurement.points_in = set.points;
  measurement.count_kept = pass.decoded.size() == set.sweeps.size();
  for (const Chunk& chunk : pass.chunks) {
    measurement.bytes += chunk.bytes.size();
    measurement.bytes_of_sweep.insert(measurement.bytes_of_sweep.end(), chunk.sweeps,
                                      chunk.bytes.size() / std::max<std::size_t>(1, chunk.sweeps));
  }
  for (std::size_t i = 0; i < pass.decoded.size(); ++i) {
    measurement.points_out += pass.decoded[i].size();
    if (i < set.sweeps.size() && pass.decoded[i].size() != set.sweeps[i].size())
      measurement.count_kept = false;
  }
  measurement.order_kept = pass.order_kept && measurement.count_kept;
}

}  // namespace

double CodecMeasurement::bits_per_point() const {
  return points_in == 0 ? 0 : 8.0 * static_cast<double>(bytes) / static_cast<double>(points_in);
}

Result<std::vector<NamedCodec>> choose_codecs(const std::vector<std::string>& names,
                                              std::map<std::string, std::string>& skipped) {
  std::vector<NamedCodec> chosen;
  std::set<std::string> unknown(names.begin(), names.end());
  std::string known;
  for (const CodecFamily& family : codec_families()) {
    known += (known.empty() ? "" : ", ") + family.name;
    unknown.erase(family.name);
    if (!names.empty() && std::find(names.begin(), names.end(), family.name) == names.end()) continue;
    auto codecs = family.settings();
    if (!codecs) {
      skipped[family.name] = codecs.error().message;
      continue;
    }
    for (auto& codec : *codecs) chosen.push_back({family.name, std::move(codec)});
  }
  if (!unknown.empty()) {
    return Error{ErrorCode::invalid_argument, "--codecs: '" + *unknown.begin() + "' is none of " + known};
  }
  return chosen;
}

CodecPass run_codec(const Codec& codec, const std::vector<PointCloud>& sweeps, const DriveContext& drive) {
  CodecPass pass;
  encode_all(codec, sweeps, drive, pass);
  if (!pass.failure) decode_all(codec, drive, pass);
  if (!pass.failure && pass.decoded.size() != sweeps.size())
    pass.failure = Error{ErrorCode::corrupt, "it gave back " + std::to_string(pass.decoded.size()) + " of " +
                                                 std::to_string(sweeps.size()) + " sweeps"};
  return pass;
}

std::vector<CodecMeasurement> measure_codecs(const std::vector<NamedCodec>& codecs, const SweepSet& set,
                                             const BenchSettings& settings,
                                             const std::function<void(std::size_t)>& progress) {
  const DriveContext drive{set.poses, settings.threads};
  const auto sample = sampled_sweeps(set.sweeps.size(), settings.nearest_sweeps);
  std::map<std::size_t, ComparedSweep> compared;
  for (const std::size_t i : sample) compared.emplace(i, set.sweeps[i]);

  const auto add_differences = [&](const CodecPass& pass, CodecMeasurement& measurement) {
    if (measurement.order_kept) {
      for (std::size_t i = 0; i < set.sweeps.size(); ++i)
        measurement.difference.own.merge(own_distances(set.sweeps[i].positions, pass.decoded[i].positions));
    }
    std::vector<CloudDifference> differences(sample.size());
    const std::vector<std::size_t> frames(sample.begin(), sample.end());
    // Not part of any timing, so on all processors.
    parallel_for(frames.size(), resolve_threads(0), [&](std::size_t i) {
      const std::vector<Point3f>& decoded = pass.decoded[frames[i]].positions;
      if (!decoded.empty()) differences[i] = nearest_differences(compared.at(frames[i]), decoded);
    });
    for (const CloudDifference& difference : differences) measurement.difference.merge(difference);
  };

  std::vector<CodecMeasurement> measurements(codecs.size());
  std::size_t passes = 0;
  for (int round = 0; round < settings.repeats; ++round) {
    for (std::size_t k = 0; k < codecs.size(); ++k) {
      // Rounds run in opposite directions: none of the codecs always follows the same one.
      const std::size_t at = round % 2 == 0 ? k : codecs.size() - 1 - k;
      CodecMeasurement& measurement = measurements[at];
      const PeakMemory memory;
      const CodecPass pass = run_codec(*codecs[at].codec, set.sweeps, drive);
      const double peak_mib =
          pass.program_peak_kib > 0 ? static_cast<double>(pass.program_peak_kib) / 1024 : memory.growth_mib();
      append(pass.encode_ms, measurement.encode_ms);
      append(pass.decode_ms, measurement.decode_ms);
      if (pass.failure) measurement.failures.push_back(pass.failure->message);
      if (round == 0) {
        describe(codecs[at], pass, set, drive, measurement);
        measurement.peak_mib = peak_mib;
        if (!pass.failure) add_differences(pass, measurement);
      }
      progress(++passes);
    }
  }
  return measurements;
}

}  // namespace pointreel
