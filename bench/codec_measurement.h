// Codecs against one another on one drive: rate, errors, times and memory of each at each of its settings.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cloud_difference.h"
#include "codecs/codec.h"
#include "sweep_set.h"

namespace pointreel {

struct BenchSettings {
  int repeats = 1;                 // rounds of all codecs, each in another order
  std::size_t nearest_sweeps = 3;  // that nearest neighbours are looked for in: they take the most time
  int threads = 1;
};

struct CodecMeasurement {
  std::string family, series, settings;
  int threads = 1;
  std::size_t sweeps = 0, points_in = 0, points_out = 0;
  std::uint64_t bytes = 0;
  std::vector<std::uint64_t> bytes_of_sweep;  // a chunk of several sweeps is split evenly
  bool order_kept = false, count_kept = false, fields_possible = false;
  CloudDifference difference;
  std::vector<double> encode_ms, decode_ms;  // of each sweep in each round
  double peak_mib = 0;  // on top of what was there before, of one pass over the drive; or of the programs run
  std::vector<std::string> failures;

  double bits_per_point() const;
};

struct NamedCodec {
  std::string family;
  std::unique_ptr<Codec> codec;
};

// Those of the families named in `names`, or of all. `skipped`: families that cannot run here, and why.
// Error: a name that is none.
Result<std::vector<NamedCodec>> choose_codecs(const std::vector<std::string>& names,
                                              std::map<std::string, std::string>& skipped);

// One codec on one drive, once: what came out, or where it failed.
struct CodecPass {
  std::vector<Chunk> chunks;
  std::vector<PointCloud> decoded;  // one a sweep
  bool order_kept = false;
  std::vector<double> encode_ms, decode_ms;  // of each sweep; those of a chunk share its time
  std::size_t program_peak_kib = 0;
  std::optional<Error> failure;
};
CodecPass run_codec(const Codec& codec, const std::vector<PointCloud>& sweeps, const DriveContext& drive);

// In the order of `codecs`. All in this process, one after another; `progress` is told how many passes are
// done.
std::vector<CodecMeasurement> measure_codecs(const std::vector<NamedCodec>& codecs, const SweepSet& set,
                                             const BenchSettings& settings,
                                             const std::function<void(std::size_t)>& progress);

}  // namespace pointreel
