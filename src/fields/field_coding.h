// The values of one field of a sweep whose geometry both sides already know, in as few bytes as they need.
//
// The encoder looks at the values and chooses per sweep: a table of the distinct values and context-mixed
// symbols (intensity), or a predictor and residual integers (ring, timestamps, anything else).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fields/point_layout.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

// What one field's coder has learned from earlier sweeps. Encoder and decoder each hold one per field, pass
// it for every sweep in the same order, and start from a new one wherever decoding may start.
class FieldMemory {
 public:
  FieldMemory();
  ~FieldMemory();
  FieldMemory(FieldMemory&&) noexcept;
  FieldMemory& operator=(FieldMemory&&) noexcept;

  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

// `values`: one a point of the layout, in the output's order. `step` 0 keeps every bit of every value (NaN
// payloads, -0.0). With a step > 0, no decoded value differs from its original by more than the step, in the
// field's own unit and computed in double (in integers for integer types); NaN and infinities stay what they
// are to the bit. The decoder need not know the step.
std::vector<std::uint8_t> encode_field(const FieldValues& values, double step, const PointLayout& layout,
                                       FieldMemory& memory);

// `type`: FieldValues::index() of the encoded values, below std::variant_size. After an Error the memory must
// not be used again. Damaged bytes may also give wrong values: guard them with a checksum.
Result<FieldValues> decode_field(std::span<const std::uint8_t> bytes, std::size_t type,
                                 const PointLayout& layout, FieldMemory& memory);

}  // namespace pointreel
