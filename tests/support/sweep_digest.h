// One line per decoded sweep that changes with any bit of its positions and fields.
#pragma once

#include <xxhash.h>

#include <cstdio>
#include <istream>
#include <string>
#include <variant>

#include "pointreel/reel.h"

namespace pointreel {

// "frame points XXH64 of the positions and then of each field: its name, the index of its type, its values".
inline std::string digest_line(const DecodedSweep& sweep) {
  const auto& positions = sweep.cloud.positions;
  XXH64_state_t* const state = XXH64_createState();
  XXH64_reset(state, 0);
  XXH64_update(state, positions.data(), positions.size() * sizeof(Point3f));
  for (const Field& field : sweep.cloud.fields) {
    XXH64_update(state, field.name.data(), field.name.size());
    const auto type = static_cast<unsigned char>(field.values.index());
    XXH64_update(state, &type, 1);
    std::visit(
        [&](const auto& values) { XXH64_update(state, values.data(), values.size() * sizeof(values[0])); },
        field.values);
  }
  char line[64];
  std::snprintf(line, sizeof(line), "%u %zu %016llx\n", sweep.frame, positions.size(),
                static_cast<unsigned long long>(XXH64_digest(state)));
  XXH64_freeState(state);
  return line;
}

// The lines of all sweeps of a whole reel.
inline Result<std::string> digest_of_reel(std::istream& stream, const std::string& name) {
  auto reader = ReelReader::open(stream, name);
  if (!reader) return reader.error();
  auto decoder = Decoder::create(reader->header());
  if (!decoder) return decoder.error();
  std::string lines;
  while (const auto packet = reader->read_packet()) {
    for (const auto& sweep : decoder->decode({&*packet, 1})) {
      if (!sweep) return sweep.error();
      lines += digest_line(*sweep);
    }
  }
  if (reader->fault()) return *reader->fault();
  return lines;
}

}  // namespace pointreel
