#include "measurement.h"

#include <optional>
#include <sstream>

#include "base/parallel.h"
#include "common/frame_totals.h"
#include "common/packet_batches.h"
#include "common/stopwatch.h"
#include "pointreel/reel.h"
#include "require.h"

namespace pointreel {
namespace {

struct EncodedReel {
  std::stringstream bytes;
  std::uint64_t size = 0;
  FrameStatistics parts;
  double encode_ms = 0;  // of all sweeps
};

EncodedReel encode_reel(const SweepSet& set, const Setting& setting) {
  Encoder encoder = require(Encoder::create(
      {.method = Method::planes, .mixture = {}, .planes = setting.planes}, Runtime{setting.threads}));
  EncodedReel reel;
  ReelWriter writer = require(ReelWriter::create(reel.bytes, encoder.header()));
  const std::vector<Pose>& poses = set.poses_from(setting.motion);
  const auto write = [&](const Result<std::vector<Packet>>& packets) {
    for (const Packet& packet : require(packets)) {
      require(writer.write(packet));
      add(reel.parts, packet.statistics);
    }
  };
  for (std::size_t i = 0; i < set.sweeps.size(); ++i) {
    PointCloud sweep = set.sweeps[i];  // the encoder keeps it; the copy is not its work
    const Stopwatch start;
    const auto packets = encoder.encode(std::move(sweep), poses.empty() ? std::optional<Pose>{} : poses[i]);
    reel.encode_ms += start.elapsed_ms();
    write(packets);
  }
  const Stopwatch start;
  const auto packets = encoder.finish();
  reel.encode_ms += start.elapsed_ms();
  write(packets);
  require(writer.finish());
  reel.size = writer.bytes_written();
  return reel;
}

// Calls use(header, sweeps) with each batch of decoded sweeps. Returns the time of decoding alone.
template <class Use>
double decode_reel(EncodedReel& reel, int threads, const Use& use) {
  ReelReader reader = require(ReelReader::open(reel.bytes, "reel in memory"));
  Decoder decoder = require(Decoder::create(reader.header(), Runtime{threads}));
  PacketBatches batches(reader, resolve_threads(threads));
  double decode_ms = 0;
  for (auto batch = batches.next(); !batch.empty(); batch = batches.next()) {
    const Stopwatch start;
    const auto results = decoder.decode(batch);
    decode_ms += start.elapsed_ms();
    std::vector<DecodedSweep> sweeps;
    sweeps.reserve(results.size());
    for (const auto& result : results) sweeps.push_back(require(result));
    use(reader.header(), sweeps);
  }
  if (reader.ending() != ReelEnding::complete) throw std::runtime_error("reel in memory: is not complete");
  return decode_ms;
}

SweepTimes per_sweep(double encode_ms, double decode_ms, std::size_t sweeps) {
  const auto count = static_cast<double>(sweeps);
  return {encode_ms / count, decode_ms / count};
}

}  // namespace

Measurement measure(const SweepSet& set, const Setting& setting, std::size_t nearest_sweeps) {
  EncodedReel reel = encode_reel(set, setting);
  Measurement measurement;
  measurement.bytes = reel.size;
  measurement.parts = reel.parts;

  const auto sample = sampled_sweeps(set.sweeps.size(), nearest_sweeps);
  measurement.nearest_sweeps = sample.size();
  const auto compare = [&](const StreamHeader& header, const std::vector<DecodedSweep>& sweeps) {
    measurement.range_bound_m = header.bound_m();
    std::vector<std::optional<Result<SweepQuality>>> qualities(sweeps.size());
    // Not part of any timing, so on all processors for those that are decoded at once.
    parallel_for(sweeps.size(), resolve_threads(0), [&](std::size_t i) {
      const PointCloud& original = set.sweeps.at(sweeps[i].frame);
      const auto pairs = pair_points(header, original, sweeps[i]);
      if (!pairs) {
        qualities[i] = pairs.error();
      } else {
        qualities[i] = sample.contains(sweeps[i].frame) ? measure_quality(original, sweeps[i], *pairs)
                                                        : measure_pairs(original, sweeps[i], *pairs);
      }
    });
    for (const auto& quality : qualities) measurement.quality.merge(require(*quality));
  };
  const double decode_ms = decode_reel(reel, setting.threads, compare);
  measurement.times = per_sweep(reel.encode_ms, decode_ms, set.sweeps.size());
  return measurement;
}

SweepTimes measure_times(const SweepSet& set, const Setting& setting) {
  EncodedReel reel = encode_reel(set, setting);
  const double decode_ms =
      decode_reel(reel, setting.threads, [](const StreamHeader&, const std::vector<DecodedSweep>&) {});
  return per_sweep(reel.encode_ms, decode_ms, set.sweeps.size());
}

}  // namespace pointreel
