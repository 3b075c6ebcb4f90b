#include <algorithm>

#include "pointreel/reel.h"

namespace pointreel {

std::vector<ReelIndexEntry> ReelIndex::needed_for(std::uint32_t frame) const {
  std::vector<ReelIndexEntry> chain;
  for (;;) {
    const auto entry = std::find_if(entries.begin(), entries.end(),
                                    [&](const ReelIndexEntry& e) { return e.frame == frame; });
    // No group is longer; references that lead in a circle are no chain.
    constexpr std::size_t kLongestGroup = 255;
    if (entry == entries.end() || chain.size() == kLongestGroup) return {};
    chain.push_back(*entry);
    if (entry->reference_frame == frame) break;
    frame = entry->reference_frame;
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

}  // namespace pointreel
