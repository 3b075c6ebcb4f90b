#include <xxhash.h>

#include <algorithm>
#include <istream>
#include <span>
#include <string>
#include <utility>

#include "base/bytes.h"
#include "codec/wire.h"
#include "pointreel/reel.h"
#include "reel/packet_search.h"
#include "reel/reel_layout.h"

namespace pointreel {
namespace {

// Small enough that a live stream of small packets is not held up by waiting for the rest of a chunk.
constexpr std::size_t kChunkBytes = 4096;

// Index and footer as ReelWriter::finish() leaves them, when checksum, sizes and place all agree.
std::optional<std::vector<ReelIndexEntry>> parse_index(std::span<const std::uint8_t> bytes,
                                                       std::uint64_t index_offset) {
  if (bytes.size() < kIndexHeaderBytes + kChecksumBytes + kFooterBytes) return {};
  const auto index_bytes = bytes.first(bytes.size() - kFooterBytes);
  ByteReader reader(index_bytes);
  const auto sync = reader.get<std::uint32_t>();
  const auto count = reader.get<std::uint32_t>();
  if (sync != kIndexSync || count > index_offset / (kPacketHeaderBytes + kChecksumBytes) ||
      index_bytes.size() != kIndexHeaderBytes + std::uint64_t{count} * kIndexEntryBytes + kChecksumBytes) {
    return {};
  }
  std::vector<ReelIndexEntry> entries(count);
  std::uint64_t offset = kStreamHeaderBytes;
  for (ReelIndexEntry& entry : entries) {
    entry.frame = reader.get<std::uint32_t>();
    entry.reference_frame = reader.get<std::uint32_t>();
    entry.bytes = reader.get<std::uint32_t>();
    entry.offset = offset;
    offset += entry.bytes;
  }
  const auto sum = reader.get<std::uint32_t>();
  ByteReader footer(bytes.last(kFooterBytes));
  const auto stated_offset = footer.get<std::uint64_t>();
  const auto magic = footer.get(kFooterMagic.size());
  if (sum != XXH32(index_bytes.data(), index_bytes.size() - kChecksumBytes, 0) || offset != index_offset ||
      stated_offset != index_offset || !std::equal(magic.begin(), magic.end(), kFooterMagic.begin())) {
    return {};
  }
  return entries;
}

}  // namespace

Result<ReelReader> ReelReader::open(std::istream& stream, std::string name) {
  ReelReader reader(stream, std::move(name));
  auto header = parse_stream_header(reader.read_bytes(kStreamHeaderBytes));
  if (!header) return Error{header.error().code, reader.name_ + ": " + header.error().message};
  reader.header_ = *std::move(header);
  return reader;
}

std::optional<Packet> ReelReader::read_packet() {
  if (ending_ != ReelEnding::open) return {};
  const std::uint64_t packet_offset = offset_;
  std::vector<std::uint8_t> bytes = read_bytes(kIndexHeaderBytes);
  const auto sync = ByteReader(bytes).get<std::uint32_t>();
  if (sync == kIndexSync) {
    end_at_index(std::move(bytes), packet_offset);
    return {};
  }
  const auto end = [&](Error error) {
    error.message = "packet at byte " + std::to_string(packet_offset) + ": " + error.message;
    end_with(error);
    unread(std::move(bytes));
    return std::nullopt;
  };
  if (bytes.empty()) return end({ErrorCode::truncated, "the file ends here without an index"});
  const auto size = packet_size(bytes);
  if (!size) return end(size.error());
  // Grown as bytes arrive, so that a damaged length cannot ask for memory that the file does not fill; nor
  // may it make the reader of a live stream wait for bytes that no one will send.
  PacketSearch search(1);
  while (bytes.size() < *size) {
    const auto more = read_bytes(std::min(kChunkBytes, *size - bytes.size()));
    if (more.empty()) break;
    bytes.insert(bytes.end(), more.begin(), more.end());
    if (const auto next = search.find(bytes)) {
      return end({ErrorCode::corrupt,
                  "damaged, another one begins within it, at byte " + std::to_string(packet_offset + *next)});
    }
  }
  auto packet = parse_packet(bytes);
  if (!packet) return end(packet.error());
  return *std::move(packet);
}

bool ReelReader::resume() {
  if (ending_ != ReelEnding::cut_off) return false;
  const std::uint64_t begin = offset_;
  std::vector<std::uint8_t> bytes = read_bytes(ahead_.size() - ahead_taken_);
  // The packet at fault itself is none.
  PacketSearch search(1);
  std::optional<std::size_t> next = search.find(bytes);
  while (!next) {
    const auto more = read_bytes(kChunkBytes);
    if (more.empty()) return false;
    bytes.insert(bytes.end(), more.begin(), more.end());
    next = search.find(bytes);
  }
  unread({bytes.begin() + static_cast<std::ptrdiff_t>(*next), bytes.end()});
  offset_ = begin + *next;
  ending_ = ReelEnding::open;
  fault_.reset();
  return true;
}

// Complete only if the index is whole and knows as many bytes of packets as were there: a packet that went
// missing with all of its bytes leaves no other trace.
void ReelReader::end_at_index(std::vector<std::uint8_t> bytes, std::uint64_t index_offset) {
  const auto end = [&](ErrorCode code, const char* what) {
    end_with({code, "index at byte " + std::to_string(index_offset) + ": " + what});
  };
  ByteReader reader(bytes);
  reader.get<std::uint32_t>();
  const auto count = reader.get<std::uint32_t>();
  if (count > index_offset / (kPacketHeaderBytes + kChecksumBytes)) {
    return end(ErrorCode::corrupt, "names more packets than there are");
  }
  const std::size_t missing = count * kIndexEntryBytes + kChecksumBytes + kFooterBytes;
  const auto rest = read_bytes(missing);
  if (!reader.ok() || rest.size() < missing) return end(ErrorCode::truncated, "the file ends within it");
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  if (!parse_index(bytes, index_offset)) return end(ErrorCode::corrupt, "damaged, or packets are missing");
  ending_ = ReelEnding::complete;
}

Result<ReelIndex> ReelReader::index() {
  ReelIndex index;
  if (auto entries = stored_index()) {
    index.entries = *std::move(entries);
  } else {
    if (!rewind_to(kStreamHeaderBytes)) return Error{ErrorCode::io_error, name_ + ": cannot seek"};
    for (std::uint64_t start = offset_; const auto packet = read_packet(); start = offset_) {
      index.entries.push_back(
          {packet->frame, packet->reference_frame, start, static_cast<std::uint32_t>(offset_ - start)});
    }
    index.fault = fault_ ? *fault_ : Error{ErrorCode::corrupt, name_ + ": the index at its end is damaged"};
  }
  if (!rewind_to(kStreamHeaderBytes)) return Error{ErrorCode::io_error, name_ + ": cannot seek"};
  return index;
}

Result<void> ReelReader::seek(const ReelIndexEntry& entry) {
  if (!rewind_to(entry.offset)) {
    return Error{ErrorCode::io_error, name_ + ": cannot seek to byte " + std::to_string(entry.offset)};
  }
  return {};
}

std::vector<std::uint8_t> ReelReader::read_bytes(std::size_t count) {
  constexpr std::size_t kMostAtOnce = 1 << 20;
  const auto ahead = std::span(std::as_const(ahead_)).subspan(ahead_taken_);
  const auto put_back = ahead.first(std::min(count, ahead.size()));
  std::vector<std::uint8_t> bytes(put_back.begin(), put_back.end());
  ahead_taken_ += put_back.size();
  while (bytes.size() < count && *stream_) {
    const std::size_t before = bytes.size();
    bytes.resize(before + std::min(kMostAtOnce, count - before));
    stream_->read(reinterpret_cast<char*>(bytes.data() + before),
                  static_cast<std::streamsize>(bytes.size() - before));
    bytes.resize(before + static_cast<std::size_t>(stream_->gcount()));
  }
  offset_ += bytes.size();
  return bytes;
}

// Puts back what read_bytes gave last.
void ReelReader::unread(std::vector<std::uint8_t> bytes) {
  offset_ -= bytes.size();
  bytes.insert(bytes.end(), ahead_.begin() + static_cast<std::ptrdiff_t>(ahead_taken_), ahead_.end());
  ahead_ = std::move(bytes);
  ahead_taken_ = 0;
}

void ReelReader::end_with(const Error& error) {
  ending_ = ReelEnding::cut_off;
  fault_ = Error{error.code, name_ + ": " + error.message};
}

// The index, found by the footer at the file's end.
std::optional<std::vector<ReelIndexEntry>> ReelReader::stored_index() {
  stream_->clear();
  stream_->seekg(0, std::ios::end);
  const auto file_bytes = static_cast<std::int64_t>(stream_->tellg());
  if (file_bytes < static_cast<std::int64_t>(kStreamHeaderBytes + kFooterBytes)) return {};
  const std::uint64_t footer_offset = static_cast<std::uint64_t>(file_bytes) - kFooterBytes;
  if (!rewind_to(footer_offset)) return {};
  const auto footer_bytes = read_bytes(kFooterBytes);
  ByteReader footer(footer_bytes);
  const auto index_offset = footer.get<std::uint64_t>();
  if (!footer.ok() || index_offset < kStreamHeaderBytes || index_offset > footer_offset ||
      !rewind_to(index_offset))
    return {};
  const auto bytes =
      read_bytes(static_cast<std::size_t>(static_cast<std::uint64_t>(file_bytes) - index_offset));
  return parse_index(bytes, index_offset);
}

bool ReelReader::rewind_to(std::uint64_t offset) {
  stream_->clear();
  ahead_.clear();
  ahead_taken_ = 0;
  stream_->seekg(static_cast<std::streamoff>(offset));
  offset_ = offset;
  ending_ = ReelEnding::open;
  fault_.reset();
  return static_cast<bool>(*stream_);
}

}  // namespace pointreel
