// What `encode` tells when it is done.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pointreel/codec.h"

namespace pointreel {

struct EncodeTotals {
  std::uint64_t frames = 0, points = 0, points_out = 0, non_finite = 0, bytes = 0;
  std::uint64_t scattered_sweeps = 0;  // method mixture: without a sensor's grid
  FrameStatistics parts;
  std::vector<double> ms_per_frame;
  bool live = false;  // sweeps came as they were measured:
  std::vector<double>
      latency_ms;  // from their arrival to their packet, of those that came during the encoding
  std::vector<std::string> fields;  // of the first sweep, kept or not
  double wall_s = 0;

  void add(const Packet& packet);
};

// `fields` as they were asked for, of method mixture. In words: to standard output, or, when the reel itself
// goes there
// (`output` is -), to the other stream.
void print_report(const EncodeTotals& totals, const StreamHeader& header, const FieldSelection& fields,
                  const std::string& output, bool as_json);

}  // namespace pointreel
