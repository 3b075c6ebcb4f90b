#include "io/columns.h"
#include "io/file_error.h"
#include "io/formats.h"
#include "io/ply_header.h"

namespace pointreel::io {

Result<std::string> serialize_ply(const PointCloud& cloud, CloudEncoding encoding) {
  if (encoding == CloudEncoding::binary_compressed) {
    return Error{ErrorCode::invalid_argument, "PLY files are ascii or binary and never compressed"};
  }
  const auto columns = columns_of(cloud);
  if (!columns) return columns.error();

  const bool is_ascii = encoding == CloudEncoding::ascii;
  std::string out = "ply\nformat ";
  out.append(is_ascii ? "ascii" : "binary_little_endian").append(" 1.0\n");
  out.append("element vertex ").append(std::to_string(cloud.size())).append("\n");
  for (const Field& column : *columns) {
    const std::string_view type_name = ply_type_names[column.values.index()];
    if (type_name.empty()) {
      return Error{ErrorCode::unsupported,
                   "field " + in_quotes(column.name) + " has 64-bit integers, a type that PLY does not have"};
    }
    out.append("property ").append(type_name).append(" ").append(column.name).append("\n");
  }
  out += "end_header\n";
  if (is_ascii) {
    append_text_rows(out, *columns);
  } else {
    append_binary_rows(out, *columns);
  }
  return out;
}

}  // namespace pointreel::io
