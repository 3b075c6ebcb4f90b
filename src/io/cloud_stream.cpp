#include "io/cloud_stream.h"

#include <algorithm>
#include <cstdint>

#include "io/file_bytes.h"
#include "io/file_error.h"
#include "io/pcd_header.h"
#include "io/ply_header.h"
#include "io/text_lines.h"

namespace pointreel::io {
namespace {

constexpr std::size_t max_header_bytes = std::size_t{64} << 10;

// Up to and with the line that starts with `last_keyword`.
std::optional<std::size_t> find_header_end(std::string_view bytes, std::string_view last_keyword) {
  for (std::size_t begin = 0, end = 0; (end = bytes.find('\n', begin)) != std::string_view::npos;
       begin = end + 1) {
    if (bytes.substr(begin).starts_with(last_keyword)) return end + 1;
  }
  return {};
}

Result<std::optional<LeadingCloud>> sized(CloudFormat format, std::size_t header_bytes,
                                          std::uint64_t body_bytes, const std::string& stream) {
  if (body_bytes > max_file_bytes - header_bytes) {
    return Error{ErrorCode::resource_limit, stream + ": the header claims " + std::to_string(body_bytes) +
                                                " bytes, more than the limit of " +
                                                std::to_string(max_file_bytes) + " for one sweep"};
  }
  return std::optional<LeadingCloud>({format, header_bytes + body_bytes});
}

// Rows times bytes each, or something above every limit.
std::uint64_t rows_bytes(std::uint64_t rows, std::uint64_t row_bytes) {
  return row_bytes != 0 && rows > max_file_bytes / row_bytes ? max_file_bytes + 1 : rows * row_bytes;
}

Result<std::optional<LeadingCloud>> leading_pcd(std::string_view header_bytes, const std::string& stream) {
  LineReader lines(header_bytes);
  const auto header = parse_pcd_header(lines, stream);
  if (!header) return header.error();
  if (header->encoding != CloudEncoding::binary) {
    return error_at_line(ErrorCode::unsupported, stream, lines.line_number(),
                         "a sweep in a stream must have 'DATA binary', which tells where it ends");
  }
  std::uint64_t row_bytes = 0;
  for (const PcdField& field : header->fields) row_bytes += field.bytes();
  return sized(CloudFormat::pcd, header_bytes.size(), rows_bytes(header->point_count, row_bytes), stream);
}

Result<std::optional<LeadingCloud>> leading_ply(std::string_view header_bytes, const std::string& stream) {
  LineReader lines(header_bytes);
  const auto header = parse_ply_header(lines, stream);
  if (!header) return header.error();
  if (!header->byte_order) {
    return error_at_line(ErrorCode::unsupported, stream, lines.line_number(),
                         "a sweep in a stream must be binary PLY, which tells where it ends");
  }
  std::uint64_t body_bytes = 0;
  for (const PlyElement& element : header->elements) {
    std::uint64_t row_bytes = 0;
    for (const PlyProperty& property : element.properties) {
      if (property.list_length_type) {
        return error_at_line(ErrorCode::unsupported, stream, element.line,
                             "element " + in_quotes(element.name) +
                                 " has a list, so that the header does not tell where the sweep ends");
      }
      row_bytes += size_of(property.type);
    }
    body_bytes =
        std::min<std::uint64_t>(body_bytes + rows_bytes(element.count, row_bytes), max_file_bytes + 1);
  }
  return sized(CloudFormat::ply, header_bytes.size(), body_bytes, stream);
}

}  // namespace

Result<std::optional<LeadingCloud>> leading_cloud(std::string_view bytes, const std::string& stream) {
  constexpr std::string_view ply_magic = "ply";
  if (bytes.size() < ply_magic.size()) return std::optional<LeadingCloud>();
  const bool is_ply = bytes.starts_with(ply_magic);
  if (!is_ply && bytes[0] != '#' && !(bytes[0] >= 'A' && bytes[0] <= 'Z')) {
    return error_at_line(
        ErrorCode::unsupported, stream, 1,
        "is " + in_quotes(bytes.substr(0, bytes.find('\n'))) +
            ", the start of no PCD or PLY file (other formats do not tell where a sweep ends)");
  }
  const auto header_bytes = find_header_end(bytes, is_ply ? "end_header" : "DATA");
  if (!header_bytes && bytes.size() <= max_header_bytes) return std::optional<LeadingCloud>();
  if (!header_bytes) {
    return error_at_line(ErrorCode::corrupt, stream, 1,
                         "the header does not end within " + std::to_string(max_header_bytes) + " bytes");
  }
  const std::string_view header = bytes.substr(0, *header_bytes);
  return is_ply ? leading_ply(header, stream) : leading_pcd(header, stream);
}

}  // namespace pointreel::io
