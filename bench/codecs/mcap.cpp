#include "codecs/mcap.h"

#include <cstring>
#include <optional>

namespace pointreel::mcap {
namespace {

constexpr std::uint8_t kMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
enum Opcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  data_end = 15
};
constexpr std::size_t kBeforeMessage = 22;  // channel, sequence number and two times

void append(Bytes& out, std::span<const std::uint8_t> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

// Everything is little-endian.
template <class T>
void append_number(Bytes& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint64_t number_at(std::span<const std::uint8_t> bytes, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
  return value;
}

void append_string(Bytes& out, const std::string& text) {
  append_number<std::uint32_t>(out, static_cast<std::uint32_t>(text.size()));
  out.insert(out.end(), text.begin(), text.end());
}

void append_record(Bytes& out, Opcode opcode, std::span<const std::uint8_t> body) {
  out.push_back(opcode);
  append_number<std::uint64_t>(out, body.size());
  append(out, body);
}

Bytes file_of_records(std::span<const std::uint8_t> records) {
  Bytes out(std::begin(kMagic), std::end(kMagic));
  append_record(out, header, Bytes(8));  // neither profile nor library
  append(out, records);
  append_record(out, data_end, Bytes(4));  // no checksum
  append_record(out, footer, Bytes(20));   // no summary
  append(out, kMagic);
  return out;
}

// The body of the first record of that kind; none: `records` end before it, or are cut off.
std::optional<std::span<const std::uint8_t>> find_record(std::span<const std::uint8_t> records,
                                                         Opcode opcode) {
  constexpr std::size_t kPrefix = 9;
  while (records.size() >= kPrefix) {
    const std::uint64_t size = number_at(records.subspan(1), 8);
    if (size > records.size() - kPrefix) return {};
    if (records[0] == opcode) return records.subspan(kPrefix, size);
    records = records.subspan(kPrefix + size);
  }
  return {};
}

}  // namespace

Bytes file_of_message(const std::string& message_type, std::span<const std::uint8_t> content) {
  Bytes records, body;
  append_number<std::uint16_t>(body, 1);  // the schema's number
  append_string(body, message_type);
  append_string(body, "ros2msg");
  append_string(body, "");  // the definition, which readers of points know
  append_record(records, schema, body);

  body.clear();
  append_number<std::uint16_t>(body, 0);  // the channel's number
  append_number<std::uint16_t>(body, 1);  // its schema
  append_string(body, "points");
  append_string(body, "cdr");
  append_string(body, "");  // no metadata
  append_record(records, channel, body);

  body.assign(kBeforeMessage, 0);
  append(body, content);
  append_record(records, message, body);
  return file_of_records(records);
}

Result<Bytes> chunk_of_file(std::span<const std::uint8_t> file) {
  const auto body =
      file.size() < sizeof(kMagic) ? std::nullopt : find_record(file.subspan(sizeof(kMagic)), chunk);
  if (!body) return Error{ErrorCode::corrupt, "no chunk in an MCAP file"};
  return Bytes(body->begin(), body->end());
}

Bytes file_of_chunk(std::span<const std::uint8_t> body) {
  Bytes records;
  append_record(records, chunk, body);
  return file_of_records(records);
}

Result<Bytes> message_of_chunk(std::span<const std::uint8_t> body) {
  // Two times, the size when not compressed, a checksum, the name of the compression, the size of the
  // records.
  constexpr std::size_t kBeforeName = 28;
  const Error error{ErrorCode::corrupt, "no message in a chunk of an MCAP file"};
  if (body.size() < kBeforeName + 12 || number_at(body.subspan(kBeforeName), 4) != 0) return error;
  const auto found = find_record(body.subspan(kBeforeName + 12), message);
  if (!found || found->size() < kBeforeMessage) return error;
  return Bytes(found->begin() + kBeforeMessage, found->end());
}

}  // namespace pointreel::mcap
