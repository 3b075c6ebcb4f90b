// The text header of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/scalar_types.h"
#include "pointreel/result.h"

namespace pointreel::io {

struct PlyProperty {
  std::string name;
  ScalarType type;                             // of the value, or of each value of a list
  std::optional<ScalarType> list_length_type;  // an integer type, for lists
};

struct PlyElement {
  std::string name;
  std::size_t line;
  std::uint64_t count;  // a claim: nothing has been compared with the file's size
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::optional<std::endian> byte_order;  // none: ascii
  std::vector<PlyElement> elements;
};

// The names that the writer uses, in the order of ScalarType. PLY has no 64-bit integers.
inline constexpr std::array<std::string_view, 10> ply_type_names = {
    "char", "uchar", "short", "ushort", "int", "uint", "", "", "float", "double"};

class LineReader;

// Leaves `lines` at the first byte of the body.
Result<PlyHeader> parse_ply_header(LineReader& lines, const std::string& file);

}  // namespace pointreel::io
