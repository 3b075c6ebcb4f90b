// ReelWriter and ReelReader: packets in .reel files and streams, with an index for access by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

#include "pointreel/codec.h"
#include "pointreel/result.h"

namespace pointreel {

// One entry per packet of a file.
struct ReelIndexEntry {
  std::uint32_t frame = 0;
  std::uint32_t reference_frame = 0;
  std::uint64_t offset = 0;  // of the packet's first byte in the file
  std::uint32_t bytes = 0;   // of the whole packet
};

struct ReelIndex {
  std::vector<ReelIndexEntry> entries;  // in file order
  std::optional<Error> fault;           // set when the file has no whole index: data may be missing

  // The entries that must be decoded for a frame, in that order, its own last: its reference, the reference's
  // reference and so on back to a key frame. Empty when one of them is not in the reel.
  std::vector<ReelIndexEntry> needed_for(std::uint32_t frame) const;
};

// Writes the header at once, each packet as it comes and flushes it: a crash loses at most the last packet.
// The index is written by finish(); a file without it is still readable.
class ReelWriter {
 public:
  // `stream` must outlive the writer; it need not be seekable.
  static Result<ReelWriter> create(std::ostream& stream, const StreamHeader& header);

  Result<void> write(const Packet& packet);
  Result<void> finish();
  std::uint64_t bytes_written() const { return offset_; }

 private:
  explicit ReelWriter(std::ostream& stream) : stream_(&stream) {}
  Result<void> write_bytes(const std::vector<std::uint8_t>& bytes);

  std::ostream* stream_;
  std::uint64_t offset_ = 0;
  std::vector<ReelIndexEntry> index_;
};

// How the packets of a reel end.
enum class ReelEnding : std::uint8_t {
  open,      // not reached yet
  complete,  // by an index that fits the packets, as ReelWriter::finish() leaves it
  cut_off,   // by the end of the bytes, a damaged packet or an index that does not fit: data may be missing
};

class ReelReader {
 public:
  // Reads the header. Errors name `name` and the offset. The stream must outlive the reader; only
  // seek_frame() and index() need it to be seekable.
  static Result<ReelReader> open(std::istream& stream, std::string name);

  const StreamHeader& header() const { return header_; }

  // The next packet, or none at the end; a damaged packet ends the reel (ending() is cut_off, fault() says
  // why), unless resume() finds a way on. Waits for no more of the stream than this packet.
  std::optional<Packet> read_packet();
  // After a damaged packet: goes on at the next whole packet, or the index, behind it. False when there is
  // none.
  bool resume();
  ReelEnding ending() const { return ending_; }
  const std::optional<Error>& fault() const { return fault_; }

  // All packets that can be reached: from the index at the file's end, or by walking the packets where that
  // is missing or damaged. Leaves the position at the first packet.
  Result<ReelIndex> index();

  // Continues reading at a packet of index().
  Result<void> seek(const ReelIndexEntry& entry);

 private:
  ReelReader(std::istream& stream, std::string name) : stream_(&stream), name_(std::move(name)) {}
  std::vector<std::uint8_t> read_bytes(std::size_t count);
  void unread(std::vector<std::uint8_t> bytes);
  void end_with(const Error& error);
  void end_at_index(std::vector<std::uint8_t> bytes, std::uint64_t index_offset);
  std::optional<std::vector<ReelIndexEntry>> stored_index();
  bool rewind_to(std::uint64_t offset);

  std::istream* stream_;
  std::string name_;
  StreamHeader header_;
  std::uint64_t offset_ = 0;
  std::vector<std::uint8_t> ahead_;  // from the stream, and put back: goes before what the stream has
  std::size_t ahead_taken_ = 0;      // read once more
  ReelEnding ending_ = ReelEnding::open;
  std::optional<Error> fault_;
};

}  // namespace pointreel
