#include <liblzf/lzf.h>

#include <limits>

#include "io/columns.h"
#include "io/formats.h"

namespace pointreel::io {
namespace {

std::string_view type_word(ScalarType type) {
  return visit_scalar_type(type, []<class T>() -> std::string_view {
    if (std::is_floating_point_v<T>) return "F";
    return std::is_signed_v<T> ? "I" : "U";
  });
}

std::string_view data_word(CloudEncoding encoding) {
  switch (encoding) {
    case CloudEncoding::ascii:
      return "ascii";
    case CloudEncoding::binary:
      return "binary";
    case CloudEncoding::binary_compressed:
      break;
  }
  return "binary_compressed";
}

std::string header_of(std::span<const Field> columns, CloudEncoding encoding) {
  std::string fields = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const Field& column : columns) {
    const ScalarType type = scalar_type_of(column.values);
    fields.append(" ").append(column.name);
    sizes.append(" ").append(std::to_string(size_of(type)));
    types.append(" ").append(type_word(type));
    counts += " 1";
  }
  const std::string point_count = std::to_string(columns.front().size());
  std::string header = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  for (const std::string& line :
       {fields, sizes, types, counts, "WIDTH " + point_count, std::string("HEIGHT 1"),
        std::string("VIEWPOINT 0 0 0 1 0 0 0"), "POINTS " + point_count}) {
    header.append(line).append("\n");
  }
  return header.append("DATA ").append(data_word(encoding)).append("\n");
}

Result<void> append_compressed(std::string& out, std::span<const Field> columns) {
  std::string body;
  append_binary_columns(body, columns);
  // LZF adds at most one byte to 32 that it cannot compress; the constant is room it wants to see at the end.
  const std::size_t max_compressed_bytes = body.size() + body.size() / 16 + 64;
  if (max_compressed_bytes > std::numeric_limits<std::uint32_t>::max()) {
    return Error{ErrorCode::resource_limit, "PCD's compressed data end at 4 GiB"};
  }
  std::string compressed(max_compressed_bytes, '\0');
  const std::uint32_t compressed_bytes =
      lzf_compress(body.data(), static_cast<unsigned>(body.size()), compressed.data(),
                   static_cast<unsigned>(compressed.size()));
  compressed.resize(compressed_bytes);

  const std::size_t sizes_at = out.size();
  out.resize(out.size() + 2 * sizeof(std::uint32_t));
  store_little_endian(out.data() + sizes_at, compressed_bytes);
  store_little_endian(out.data() + sizes_at + sizeof(std::uint32_t), static_cast<std::uint32_t>(body.size()));
  out += compressed;
  return {};
}

}  // namespace

Result<std::string> serialize_pcd(const PointCloud& cloud, CloudEncoding encoding) {
  if (cloud.find_field("_") != nullptr) {
    return Error{ErrorCode::invalid_argument, "'_' is the name of padding in PCD and not of a field"};
  }
  const auto columns = columns_of(cloud);
  if (!columns) return columns.error();
  std::string out = header_of(*columns, encoding);
  switch (encoding) {
    case CloudEncoding::ascii:
      append_text_rows(out, *columns);
      break;
    case CloudEncoding::binary:
      append_binary_rows(out, *columns);
      break;
    case CloudEncoding::binary_compressed:
      if (const auto done = append_compressed(out, *columns); !done) return done.error();
      break;
  }
  return out;
}

}  // namespace pointreel::io
