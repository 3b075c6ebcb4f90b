// A procedural street without end: blocks are made ahead of the car and dropped behind it.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "sim/ground.h"
#include "sim/road.h"
#include "sim/scene_object.h"

namespace pointreel::sim {

struct StreetBlock {
  std::int64_t index;                // covers world x from index * street_block_length_m
  std::vector<Crossing> crossings;   // none or one
  std::vector<SceneObject> objects;  // all of them stand still
};

inline constexpr double street_block_length_m = 72;

// The same (seed, index) always gives the same block.
StreetBlock make_street_block(const Road& road, std::uint64_t seed, std::int64_t index);

class Street {
 public:
  Street(const Road& road, std::uint64_t seed) : road_(road), seed_(seed) {}

  // Keeps exactly the blocks that touch world x in [begin_x_m, end_x_m]; neither end may move back.
  void cover(double begin_x_m, double end_x_m);
  const std::deque<StreetBlock>& blocks() const { return blocks_; }

 private:
  const Road& road_;
  std::uint64_t seed_;
  std::deque<StreetBlock> blocks_;
};

}  // namespace pointreel::sim
