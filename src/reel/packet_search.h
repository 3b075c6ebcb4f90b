// Finds the first whole packet, or index, in bytes that may begin anywhere and are still arriving: the way on
// after damage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pointreel {

class PacketSearch {
 public:
  // Starts to look at `begin`.
  explicit PacketSearch(std::size_t begin) : looked_at_(begin) {}

  // Offset of the first one whose checksum is right. `bytes` are those of the last call and what came since.
  // What is not whole yet stays a candidate, as a damaged length must not hide the packets behind it.
  std::optional<std::size_t> find(std::span<const std::uint8_t> bytes);

 private:
  struct Candidate {
    std::size_t begin;
    std::size_t end;  // of the bytes that it takes to judge it
  };
  enum class Finding : std::uint8_t { whole, incomplete, nothing };
  Finding judge(Candidate& candidate, std::span<const std::uint8_t> bytes);

  std::size_t looked_at_;  // sync words before this are known
  std::vector<Candidate> candidates_;
  std::uint64_t summed_bytes_ = 0;  // what checksums were taken of
};

}  // namespace pointreel
