#include "reel/packet_search.h"

#include <xxhash.h>

#include "base/bytes.h"
#include "codec/wire.h"
#include "reel/reel_layout.h"

namespace pointreel {
namespace {

// By chance a sync word stands once in 2 GB. Bytes that are full of them are malicious and must not take time
// without end.
constexpr std::size_t kMostCandidates = 64;
constexpr std::uint64_t kMostSumsPerByte = 8;

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  return ByteReader(bytes.subspan(offset)).get<std::uint32_t>();
}

}  // namespace

std::optional<std::size_t> PacketSearch::find(std::span<const std::uint8_t> bytes) {
  for (; looked_at_ + sizeof(std::uint32_t) <= bytes.size(); ++looked_at_) {
    if (bytes[looked_at_] != (kPacketSync & 0xFF)) continue;  // both sync words start with a P
    const std::uint32_t word = word_at(bytes, looked_at_);
    if ((word == kPacketSync || word == kIndexSync) && candidates_.size() < kMostCandidates) {
      candidates_.push_back({looked_at_, looked_at_ + kIndexHeaderBytes});
    }
  }
  for (auto candidate = candidates_.begin(); candidate != candidates_.end();) {
    switch (judge(*candidate, bytes)) {
      case Finding::whole:
        return candidate->begin;
      case Finding::incomplete:
        ++candidate;
        break;
      case Finding::nothing:
        candidate = candidates_.erase(candidate);
        break;
    }
  }
  return {};
}

PacketSearch::Finding PacketSearch::judge(Candidate& candidate, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < candidate.end) return Finding::incomplete;
  const auto from_here = bytes.subspan(candidate.begin);
  const bool is_packet = word_at(from_here, 0) == kPacketSync;
  std::uint64_t size = 0;  // without the footer, for an index
  if (is_packet) {
    const auto packet = packet_size(from_here);
    if (!packet) return Finding::nothing;
    size = *packet;
  } else {
    size = kIndexHeaderBytes + std::uint64_t{word_at(from_here, 4)} * kIndexEntryBytes + kChecksumBytes;
  }
  candidate.end = candidate.begin + size;
  if (bytes.size() < candidate.end) return Finding::incomplete;
  summed_bytes_ += size;
  if (summed_bytes_ > kMostSumsPerByte * bytes.size()) return Finding::nothing;
  if (is_packet) return parse_packet(from_here.first(size)) ? Finding::whole : Finding::nothing;
  const std::uint64_t summed = size - kChecksumBytes;
  return word_at(from_here, summed) == XXH32(bytes.data() + candidate.begin, summed, 0) ? Finding::whole
                                                                                        : Finding::nothing;
}

}  // namespace pointreel
