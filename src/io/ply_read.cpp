#include <algorithm>

#include "io/columns.h"
#include "io/file_error.h"
#include "io/formats.h"
#include "io/ply_header.h"
#include "io/text_lines.h"

namespace pointreel::io {
namespace {

bool has_list(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& property) { return property.list_length_type.has_value(); });
}

// Of an element without lists.
std::size_t row_bytes_of(const PlyElement& element) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) bytes += size_of(property.type);
  return bytes;
}

std::vector<ColumnLayout> lay_out(const PlyElement& vertex) {
  std::vector<ColumnLayout> columns;
  const std::size_t row_bytes = row_bytes_of(vertex);
  std::size_t offset_bytes = 0;
  for (const PlyProperty& property : vertex.properties) {
    columns.push_back({property.name, property.type, columns.size(), offset_bytes, row_bytes});
    offset_bytes += size_of(property.type);
  }
  return columns;
}

Result<void> check_vertex(const PlyHeader& header, const std::string& file, std::size_t last_line) {
  const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                   [](const PlyElement& element) { return element.name == "vertex"; });
  if (vertex == header.elements.end()) {
    return error_at_line(ErrorCode::unsupported, file, last_line, "the header has no element 'vertex'");
  }
  if (has_list(*vertex)) {
    return error_at_line(ErrorCode::unsupported, file, vertex->line, "element 'vertex' has a list property");
  }
  return check_columns(lay_out(*vertex), file, vertex->line);
}

// Each row is a line, whatever it holds; an element without properties has no lines.
Result<void> skip_text_rows(const PlyElement& element, LineReader& lines, const std::string& file) {
  std::vector<std::string_view> words;
  for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row) {
    if (!lines.next_words(words)) {
      return error_at_line(ErrorCode::truncated, file, lines.line_number(),
                           "the file ends after " + std::to_string(row) + " of " +
                               std::to_string(element.count) + " rows of element " + in_quotes(element.name));
    }
  }
  return {};
}

// A list's length, or none when it is negative or runs past the end.
std::optional<std::uint64_t> list_bytes(const PlyProperty& list, std::string_view rest,
                                        std::endian byte_order) {
  return visit_scalar_type(*list.list_length_type, [&]<class T>() -> std::optional<std::uint64_t> {
    if (rest.size() < sizeof(T)) return std::nullopt;
    const T length = load<T>(rest.data(), byte_order);
    if (length < 0) return std::nullopt;
    // Lengths have at most 32 bits, so this cannot overflow.
    const std::uint64_t bytes = sizeof(T) + static_cast<std::uint64_t>(length) * size_of(list.type);
    if (bytes > rest.size()) return std::nullopt;
    return bytes;
  });
}

// The offset after the element's rows.
Result<std::size_t> skip_binary_rows(const PlyElement& element, std::string_view bytes, std::size_t offset,
                                     std::endian byte_order, const std::string& file) {
  if (!has_list(element)) {
    const std::size_t row_bytes = row_bytes_of(element);
    const auto present = check_rows_present(element.count, row_bytes, bytes, offset, file);
    if (!present) return present.error();
    return offset + element.count * row_bytes;
  }
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) {
      const std::string_view rest = bytes.substr(offset);
      const std::optional<std::uint64_t> value_bytes =
          property.list_length_type ? list_bytes(property, rest, byte_order) : size_of(property.type);
      if (!value_bytes || *value_bytes > rest.size()) {
        return error_at_byte(ErrorCode::truncated, file, offset,
                             "row " + std::to_string(row) + " of element " + in_quotes(element.name) +
                                 " runs past the end of the file");
      }
      offset += *value_bytes;
    }
  }
  return offset;
}

Result<std::vector<Field>> read_text(const PlyHeader& header, LineReader& lines, const std::string& file) {
  std::vector<Field> columns;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      auto rows = read_text_rows(lines, lay_out(element), element.properties.size(), element.count, file);
      if (!rows) return rows;
      columns = *std::move(rows);
    } else if (const auto skipped = skip_text_rows(element, lines, file); !skipped) {
      return skipped.error();
    }
  }
  if (const auto end = check_no_line_left(lines, file); !end) return end.error();
  return columns;
}

Result<std::vector<Field>> read_binary(const PlyHeader& header, std::string_view bytes, std::size_t offset,
                                       const std::string& file) {
  std::vector<Field> columns;
  std::size_t vertex_bytes = 0;
  for (const PlyElement& element : header.elements) {
    const auto end = skip_binary_rows(element, bytes, offset, *header.byte_order, file);
    if (!end) return end.error();
    if (element.name == "vertex") {
      columns =
          read_binary_columns(bytes.data() + offset, lay_out(element), element.count, *header.byte_order);
      vertex_bytes = row_bytes_of(element);
    }
    offset = *end;
  }
  if (const auto end = check_no_row_left(vertex_bytes, bytes, offset, file); !end) return end.error();
  return columns;
}

}  // namespace

Result<PointCloud> parse_ply(std::string_view bytes, const std::string& file) {
  LineReader lines(bytes);
  const auto header = parse_ply_header(lines, file);
  if (!header) return header.error();
  if (const auto valid = check_vertex(*header, file, lines.line_number()); !valid) return valid.error();
  auto columns = header->byte_order ? read_binary(*header, bytes, lines.offset(), file)
                                    : read_text(*header, lines, file);
  if (!columns) return columns.error();
  return cloud_from_columns(*std::move(columns));
}

}  // namespace pointreel::io
