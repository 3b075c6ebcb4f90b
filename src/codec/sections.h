// Sections of a payload: runs of bytes behind their length, and small numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/bytes.h"

namespace pointreel {

// Seven bits a byte, low ones first.
inline void put_varint(ByteWriter& writer, std::uint64_t value) {
  while (value >= 0x80) {
    writer.put(static_cast<std::uint8_t>(value | 0x80));
    value >>= 7;
  }
  writer.put(static_cast<std::uint8_t>(value));
}
// 0, and the reader is no longer ok(), where the bytes end too soon.
inline std::uint64_t get_varint(ByteReader& reader) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 63; shift += 7) {
    const auto byte = reader.get<std::uint8_t>();
    value |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
    if (byte < 0x80) break;
  }
  return value;
}

inline void put_section(ByteWriter& writer, std::span<const std::uint8_t> bytes) {
  put_varint(writer, bytes.size());
  writer.put(bytes);
}
inline std::span<const std::uint8_t> get_section(ByteReader& reader) {
  return reader.get(static_cast<std::size_t>(get_varint(reader)));
}

// For statistics by part.
inline double bits_of(std::size_t bytes) {
  return 8.0 * static_cast<double>(bytes);
}

}  // namespace pointreel
