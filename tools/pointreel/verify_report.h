// What `verify` found.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/field_quality.h"
#include "common/quality.h"
#include "pointreel/codec.h"

namespace pointreel {

struct Verification {
  SweepQuality quality;
  FieldDifferences fields;
  std::uint64_t frames = 0;
  std::uint64_t frames_missing = 0;    // originals without a decoded sweep
  std::uint64_t frames_reordered = 0;  // whose points come in another order; their fields are not compared
  bool temporal = false;               // sensor's grid: sweeps predicted from the one before were met
  std::uint64_t bytes = 0, field_bytes = 0;  // of the packets; of which of fields
  std::vector<double> encode_ms, decode_ms;
};

// On the sensor's grid: no point is lost and each is within the bound. On the uniform one: the ray error of
// each kept point is. None where no sweep was decoded.
std::optional<bool> bound_held(const Verification& verification, const StreamHeader& header);

void print_json(const Verification& verification, const StreamHeader& header);
void print_table(const Verification& verification, const StreamHeader& header, const std::string& reel);

}  // namespace pointreel
