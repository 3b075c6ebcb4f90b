#include <xxhash.h>

#include <ostream>
#include <span>
#include <string>

#include "base/bytes.h"
#include "codec/wire.h"
#include "pointreel/reel.h"
#include "reel/reel_layout.h"

namespace pointreel {

Result<ReelWriter> ReelWriter::create(std::ostream& stream, const StreamHeader& header) {
  ReelWriter writer(stream);
  if (auto written = writer.write_bytes(serialize(header)); !written) return written.error();
  return writer;
}

Result<void> ReelWriter::write(const Packet& packet) {
  const auto bytes = serialize(packet);
  const ReelIndexEntry entry{packet.frame, packet.reference_frame, offset_,
                             static_cast<std::uint32_t>(bytes.size())};
  if (auto written = write_bytes(bytes); !written) return written;
  index_.push_back(entry);
  return {};
}

Result<void> ReelWriter::finish() {
  const std::uint64_t index_offset = offset_;
  ByteWriter index;
  index.put(kIndexSync);
  index.put(static_cast<std::uint32_t>(index_.size()));
  for (const ReelIndexEntry& entry : index_) {
    index.put(entry.frame);
    index.put(entry.reference_frame);
    index.put(entry.bytes);
  }
  index.put(XXH32(index.bytes().data(), index.size(), 0));
  index.put(index_offset);
  index.put(std::span(kFooterMagic));
  return write_bytes(index.take());
}

Result<void> ReelWriter::write_bytes(const std::vector<std::uint8_t>& bytes) {
  stream_->write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream_->flush();
  if (!*stream_) {
    return Error{ErrorCode::io_error,
                 "cannot write the reel at byte " + std::to_string(offset_) + " (disk full?)"};
  }
  offset_ += bytes.size();
  return {};
}

}  // namespace pointreel
