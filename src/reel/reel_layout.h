// The container's own records (docs/FORMAT.md): header, packets, index, footer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pointreel {

// Index: sync word, number of packets, an entry each in file order, checksum.
inline constexpr std::uint32_t kIndexSync = 0x58495250;  // "PRIX"
inline constexpr std::size_t kIndexHeaderBytes = 8;
inline constexpr std::size_t kIndexEntryBytes = 12;  // frame, reference frame, bytes; offsets add up

// Footer, the last bytes of a complete file: offset of the index, magic.
inline constexpr std::array<std::uint8_t, 8> kFooterMagic = {'R', 'E', 'E', 'L', 'E', 'N', 'D', '\n'};
inline constexpr std::size_t kFooterBytes = 16;

}  // namespace pointreel
