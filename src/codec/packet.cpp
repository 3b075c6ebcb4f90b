// Packets and the stream header as bytes. docs/FORMAT.md is the normative description.
#include <xxhash.h>

#include <cmath>
#include <string>

#include "base/bytes.h"
#include "codec/wire.h"
#include "pointreel/codec.h"

namespace pointreel {
namespace {

std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  return XXH32(bytes.data(), bytes.size(), 0);
}

Error error_at(ErrorCode code, std::size_t offset, const std::string& what) {
  return {code, what + " at byte " + std::to_string(offset)};
}

}  // namespace

std::vector<std::uint8_t> serialize(const Packet& packet) {
  ByteWriter writer;
  writer.put(kPacketSync);
  writer.put(static_cast<std::uint32_t>(packet.payload.size()));
  writer.put(packet.frame);
  writer.put(packet.group);
  writer.put(packet.reference_frame);
  writer.put(packet.points_in);
  writer.put(packet.points_out);
  writer.put(packet.non_finite);
  writer.put(packet.kind);
  writer.put(std::span(packet.payload));
  writer.put(checksum(writer.bytes()));
  return writer.take();
}

Result<std::size_t> packet_size(std::span<const std::uint8_t> prefix) {
  ByteReader reader(prefix);
  const auto sync = reader.get<std::uint32_t>();
  const auto payload_bytes = reader.get<std::uint32_t>();
  if (!reader.ok()) return error_at(ErrorCode::truncated, prefix.size(), "packet ends within its header");
  if (sync != kPacketSync) return error_at(ErrorCode::corrupt, 0, "no packet sync word");
  if (payload_bytes > kMaxPayloadBytes)
    return error_at(ErrorCode::corrupt, 4, "packet claims a payload that is too large");
  return kPacketHeaderBytes + payload_bytes + kChecksumBytes;
}

Result<Packet> parse_packet(std::span<const std::uint8_t> bytes) {
  const auto size = packet_size(bytes.first(std::min(bytes.size(), kPacketHeaderBytes)));
  if (!size) return size.error();
  if (bytes.size() < *size)
    return error_at(ErrorCode::truncated, bytes.size(), "packet ends before its checksum");
  if (bytes.size() > *size) return error_at(ErrorCode::corrupt, *size, "bytes follow the packet");

  ByteReader reader(bytes);
  reader.get(8);
  Packet packet;
  packet.frame = reader.get<std::uint32_t>();
  packet.group = reader.get<std::uint32_t>();
  packet.reference_frame = reader.get<std::uint32_t>();
  packet.points_in = reader.get<std::uint32_t>();
  packet.points_out = reader.get<std::uint32_t>();
  packet.non_finite = reader.get<std::uint32_t>();
  const auto kind = reader.get<std::uint8_t>();
  const auto payload = reader.get(*size - kPacketHeaderBytes - kChecksumBytes);
  if (reader.get<std::uint32_t>() != checksum(bytes.first(bytes.size() - kChecksumBytes))) {
    return error_at(ErrorCode::corrupt, bytes.size() - kChecksumBytes, "packet checksum does not match");
  }
  if (kind > static_cast<std::uint8_t>(FrameKind::predicted)) {
    return error_at(ErrorCode::unsupported, kPacketHeaderBytes - 1,
                    "unknown packet kind " + std::to_string(kind));
  }
  packet.kind = static_cast<FrameKind>(kind);
  if ((packet.kind == FrameKind::key) != (packet.reference_frame == packet.frame)) {
    return error_at(ErrorCode::corrupt, 16, "packet kind and reference frame contradict each other");
  }
  if (std::uint64_t{packet.points_out} + packet.non_finite > packet.points_in) {
    return error_at(ErrorCode::corrupt, 20, "packet counts more points out than in");
  }
  packet.payload.assign(payload.begin(), payload.end());
  return packet;
}

std::vector<std::uint8_t> serialize(const StreamHeader& header) {
  ByteWriter writer;
  writer.put(std::span(kStreamMagic));
  writer.put(kFormatVersion);
  writer.put(header.method);
  if (header.on_sensor_grid()) {
    writer.put(header.effort);
    writer.put(static_cast<std::uint8_t>(header.group));
    writer.put(std::uint8_t{0});
    writer.put(header.method == Method::planes ? PlaneGrid::sensor : PlaneGrid{});
    while (writer.size() < kMaxErrorOffset) writer.put(std::uint8_t{0});
    writer.put(header.max_error_m);
    while (writer.size() < kStreamHeaderBytes - kChecksumBytes) writer.put(std::uint8_t{0});
  } else {
    writer.put(static_cast<std::uint8_t>(header.planes.tile_size));
    writer.put(static_cast<std::uint8_t>(header.planes.group));
    writer.put(header.planes.residual_mode);
    writer.put(header.planes.grid);
    writer.put(std::uint8_t{0});
    writer.put(header.planes.threshold_m);
    writer.put(header.planes.azimuth_step_rad);
    writer.put(header.planes.elevation_step_rad);
    writer.put(header.planes.residual_step_m);
  }
  writer.put(checksum(writer.bytes()));
  return writer.take();
}

Result<StreamHeader> parse_stream_header(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  const auto magic = reader.get(kStreamMagic.size());
  if (!reader.ok()) return error_at(ErrorCode::truncated, bytes.size(), "stream ends within its header");
  if (!std::equal(magic.begin(), magic.end(), kStreamMagic.begin())) {
    return error_at(ErrorCode::corrupt, 0, "not a .reel stream: no magic bytes");
  }
  const auto version = reader.get<std::uint16_t>();
  if (reader.ok() && version != kFormatVersion) {
    return error_at(ErrorCode::unsupported, kStreamMagic.size(),
                    "format version " + std::to_string(version) + " is not known to this program");
  }
  StreamHeader header;
  header.method = reader.get<Method>();
  // The same place for both grids; method mixture has 0 there.
  header.planes.grid = bytes.size() > kGridOffset ? static_cast<PlaneGrid>(bytes[kGridOffset]) : PlaneGrid{};
  std::uint64_t reserved = 0;
  if (header.on_sensor_grid()) {
    header.effort = reader.get<Effort>();
    header.group = reader.get<std::uint8_t>();
    reserved |= reader.get<std::uint8_t>();
    reserved |= reader.get<std::uint8_t>() != 0 && header.method != Method::planes ? 1U : 0U;
    reserved |= reader.get<std::uint8_t>();
    header.max_error_m = reader.get<double>();
    for (int i = 0; i < 3; ++i) reserved |= reader.get<std::uint64_t>();
  } else {
    header.planes.tile_size = reader.get<std::uint8_t>();
    header.planes.group = reader.get<std::uint8_t>();
    header.planes.residual_mode = reader.get<ResidualMode>();
    reader.get<PlaneGrid>();
    reserved = reader.get<std::uint8_t>();
    header.planes.threshold_m = reader.get<double>();
    header.planes.azimuth_step_rad = reader.get<double>();
    header.planes.elevation_step_rad = reader.get<double>();
    header.planes.residual_step_m = reader.get<double>();
  }
  const auto sum = reader.get<std::uint32_t>();
  if (!reader.ok()) return error_at(ErrorCode::truncated, bytes.size(), "stream ends within its header");
  if (bytes.size() != kStreamHeaderBytes)
    return error_at(ErrorCode::corrupt, kStreamHeaderBytes, "bytes follow the header");
  if (sum != checksum(bytes.first(kStreamHeaderBytes - kChecksumBytes))) {
    return error_at(ErrorCode::corrupt, kStreamHeaderBytes - kChecksumBytes,
                    "stream header checksum does not match");
  }
  if (reserved != 0) return error_at(ErrorCode::unsupported, 14, "reserved header bytes are not zero");
  if (const auto valid = validate(header); !valid)
    return Error{ErrorCode::corrupt, "stream header: " + valid.error().message};
  return header;
}

}  // namespace pointreel
