// Constants of the byte format that packets, container and tests share (docs/FORMAT.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pointreel/codec.h"

namespace pointreel {

// 0x89 keeps text tools away, CR LF catches line-end conversion, 0x1A stops a DOS `type` (after PNG).
inline constexpr std::array<std::uint8_t, 8> kStreamMagic = {0x89, 'R', 'E', 'E', 'L', '\r', '\n', 0x1A};
inline constexpr std::uint16_t kFormatVersion = 1;
inline constexpr std::size_t kChecksumBytes = 4;  // XXH32, seed 0, of everything before it
inline constexpr std::size_t kStreamHeaderBytes = 52;
inline constexpr std::size_t kGridOffset = 14;  // of method `planes`
inline constexpr std::size_t kMaxErrorOffset = 16;

inline constexpr std::uint32_t kPacketSync = 0x4B505250;  // "PRPK"
inline constexpr std::size_t kPacketHeaderBytes = 33;
inline constexpr std::uint32_t kMaxPayloadBytes = 1u << 28;
inline constexpr std::uint32_t kMaxPointsPerSweep = 1u << 23;  // of method `mixture`

// Size of the whole packet from its first kPacketHeaderBytes (or fewer, if no more are there).
Result<std::size_t> packet_size(std::span<const std::uint8_t> prefix);

// Error invalid_argument naming the option that is out of range.
Result<void> validate(const StreamHeader& header);

}  // namespace pointreel
