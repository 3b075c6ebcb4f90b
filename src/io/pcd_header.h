// The text header of a PCD file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/scalar_types.h"
#include "pointreel/io.h"
#include "pointreel/result.h"

namespace pointreel::io {

// One entry of FIELDS: `count` values of one type, next to each other.
struct PcdField {
  std::string name;
  ScalarType type;
  std::size_t value_bytes;
  std::size_t count;

  bool is_padding() const { return name == "_"; }  // its type means nothing
  std::size_t bytes() const { return value_bytes * count; }
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t fields_line;
  std::uint64_t point_count;  // a claim: nothing has been compared with the file's size
  CloudEncoding encoding;
};

class LineReader;

// Leaves `lines` at the first byte of the body. One row of all fields takes at most 64 KiB.
Result<PcdHeader> parse_pcd_header(LineReader& lines, const std::string& file);

}  // namespace pointreel::io
