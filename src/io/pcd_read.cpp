#include <liblzf/lzf.h>

#include <optional>

#include "io/columns.h"
#include "io/file_error.h"
#include "io/formats.h"
#include "io/pcd_header.h"
#include "io/text_lines.h"

namespace pointreel::io {
namespace {

// How the values lie in the body.
enum class Order : std::uint8_t {
  rows,                     // point by point: ascii, binary
  columns,                  // field by field: binary_compressed
  columns_without_padding,  // as PCL writes binary_compressed, even where FIELDS lists padding
};

std::size_t row_bytes_of(const PcdHeader& header, Order order) {
  std::size_t bytes = 0;
  for (const PcdField& field : header.fields) {
    if (order != Order::columns_without_padding || !field.is_padding()) bytes += field.bytes();
  }
  return bytes;
}

std::size_t words_per_row(const PcdHeader& header) {
  std::size_t words = 0;
  for (const PcdField& field : header.fields) words += field.count;
  return words;
}

// A field of COUNT n > 1 becomes the columns name_0 to name_<n-1>; padding becomes none.
// For column orders `point_count` must already be known to fit the body.
std::vector<ColumnLayout> lay_out(const PcdHeader& header, Order order, std::size_t point_count) {
  std::vector<ColumnLayout> columns;
  const std::size_t row_bytes = row_bytes_of(header, order);
  std::size_t word_index = 0;
  std::size_t offset_bytes = 0;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count && !field.is_padding(); ++k) {
      const std::string name = field.count == 1 ? field.name : field.name + "_" + std::to_string(k);
      columns.push_back({name, field.type, word_index + k, offset_bytes + k * field.value_bytes,
                         order == Order::rows ? row_bytes : field.bytes()});
    }
    word_index += field.count;
    if (order == Order::columns_without_padding && field.is_padding()) continue;
    offset_bytes += order == Order::rows ? field.bytes() : field.bytes() * point_count;
  }
  return columns;
}

Result<std::vector<Field>> read_ascii(const PcdHeader& header, LineReader& lines, const std::string& file) {
  auto columns =
      read_text_rows(lines, lay_out(header, Order::rows, 0), words_per_row(header), header.point_count, file);
  if (!columns) return columns;
  if (const auto end = check_no_line_left(lines, file); !end) return end.error();
  return columns;
}

Result<std::vector<Field>> read_binary(const PcdHeader& header, std::string_view bytes, std::size_t offset,
                                       const std::string& file) {
  const std::size_t row_bytes = row_bytes_of(header, Order::rows);
  if (const auto present = check_rows_present(header.point_count, row_bytes, bytes, offset, file); !present) {
    return present.error();
  }
  const std::size_t end = offset + header.point_count * row_bytes;
  if (const auto nothing_left = check_no_row_left(row_bytes, bytes, end, file); !nothing_left) {
    return nothing_left.error();
  }
  return read_binary_columns(bytes.data() + offset, lay_out(header, Order::rows, 0), header.point_count,
                             std::endian::little);
}

// The LZF body: uint32 compressed bytes, uint32 bytes after decompression, the compressed bytes.
Result<std::string> decompress(std::string_view bytes, std::size_t offset, const std::string& file) {
  constexpr std::size_t sizes_bytes = 2 * sizeof(std::uint32_t);
  // LZF's longest back reference turns 3 bytes into 264. Checked before so much memory is taken.
  constexpr std::size_t max_expansion = 88;

  if (bytes.size() - offset < sizes_bytes) {
    return error_at_byte(ErrorCode::truncated, file, offset,
                         "the file ends before the sizes of the compressed data");
  }
  const auto compressed_bytes = load<std::uint32_t>(bytes.data() + offset, std::endian::little);
  const auto full_bytes =
      load<std::uint32_t>(bytes.data() + offset + sizeof(std::uint32_t), std::endian::little);
  const std::string_view body = bytes.substr(offset + sizes_bytes);
  if (compressed_bytes > body.size()) {
    return error_at_byte(ErrorCode::truncated, file, offset,
                         "the compressed data should have " + std::to_string(compressed_bytes) +
                             " bytes, but only " + std::to_string(body.size()) + " follow");
  }
  if (full_bytes / max_expansion > compressed_bytes) {
    return error_at_byte(ErrorCode::corrupt, file, offset,
                         std::to_string(compressed_bytes) + " compressed bytes cannot hold " +
                             std::to_string(full_bytes) + " bytes");
  }
  std::string full(full_bytes, '\0');
  if (full.empty() && compressed_bytes == 0) return full;
  if (lzf_decompress(body.data(), compressed_bytes, full.data(), full_bytes) != full_bytes || full.empty()) {
    return error_at_byte(ErrorCode::corrupt, file, offset + sizes_bytes, "the compressed data are damaged");
  }
  return full;
}

// The order that gives exactly `body_bytes`.
std::optional<Order> order_of_compressed(const PcdHeader& header, std::size_t body_bytes) {
  for (const Order order : {Order::columns, Order::columns_without_padding}) {
    const std::size_t row_bytes = row_bytes_of(header, order);
    if (body_bytes % row_bytes == 0 && body_bytes / row_bytes == header.point_count) return order;
  }
  return std::nullopt;
}

Result<std::vector<Field>> read_compressed(const PcdHeader& header, std::string_view bytes,
                                           std::size_t offset, const std::string& file) {
  std::string body;
  if (header.point_count != 0 || offset != bytes.size()) {  // some writers end an empty cloud with the header
    auto decompressed = decompress(bytes, offset, file);
    if (!decompressed) return decompressed.error();
    body = *std::move(decompressed);
  }
  const auto order = order_of_compressed(header, body.size());
  if (!order) {
    return error_at_byte(ErrorCode::corrupt, file, offset,
                         "the data have " + std::to_string(body.size()) +
                             " bytes after decompression, which are not " +
                             std::to_string(header.point_count) + " points of " +
                             std::to_string(row_bytes_of(header, Order::columns)) + " bytes");
  }
  return read_binary_columns(body.data(), lay_out(header, *order, header.point_count), header.point_count,
                             std::endian::little);
}

Result<std::vector<Field>> read_body(const PcdHeader& header, LineReader& lines, std::string_view bytes,
                                     const std::string& file) {
  switch (header.encoding) {
    case CloudEncoding::ascii:
      return read_ascii(header, lines, file);
    case CloudEncoding::binary:
      return read_binary(header, bytes, lines.offset(), file);
    case CloudEncoding::binary_compressed:
      break;
  }
  return read_compressed(header, bytes, lines.offset(), file);
}

}  // namespace

Result<PointCloud> parse_pcd(std::string_view bytes, const std::string& file) {
  LineReader lines(bytes);
  const auto header = parse_pcd_header(lines, file);
  if (!header) return header.error();
  if (const auto valid = check_columns(lay_out(*header, Order::rows, 0), file, header->fields_line); !valid) {
    return valid.error();
  }
  auto columns = read_body(*header, lines, bytes, file);
  if (!columns) return columns.error();
  return cloud_from_columns(*std::move(columns));
}

}  // namespace pointreel::io
