#include "planes/plane_search.h"

#include <bit>
#include <optional>
#include <utility>

#include "planes/tile_samples.h"

namespace pointreel {
namespace {

using PlaneTest = TileSamples::PlaneTest;

class Search {
 public:
  explicit Search(const PlaneTask& task) : task_(task), samples_(task) {
    planes_.tiles = samples_.tiles();
    planes_.plane_of_tile.assign(tiles().count(), -1);
  }

  PlaneTiles run() {
    for (int tile_row = 0; tile_row < tiles().down; ++tile_row) {
      for (int tile = 0; tile < tiles().across; ++tile) {
        std::int32_t& plane = planes_.plane_of_tile[tiles().index(tile_row, tile)];
        plane = known_plane(tile_row, tile);
        if (plane >= 0 || !samples_.has_returns(tile_row, tile)) continue;
        if (const auto found = plane_for(tile_row, tile)) {
          plane = static_cast<std::int32_t>(planes_.planes.size());
          planes_.planes.push_back(*found);
        }
      }
    }
    return std::move(planes_);
  }

 private:
  const TileGrid& tiles() const { return planes_.tiles; }

  // That of a neighbour which holds here, too; -1: none does.
  std::int32_t known_plane(int tile_row, int tile) const {
    const NeighbourPlanes around(planes_, tile_row, tile);
    const auto holds = [&](std::int32_t plane) {
      return PlaneTest(samples_, planes_.planes[static_cast<std::size_t>(plane)].plane, tile_row).holds(tile);
    };
    for (const std::int32_t plane : around.distinct()) {
      if (plane >= 0 && holds(plane)) return plane;
    }
    return -1;
  }

  // The plane of an earlier sweep at a new distance, if that holds half of the tiles that the plane through
  // the tile would hold, or more; else the latter.
  std::optional<TilePlane> plane_for(int tile_row, int tile) {
    const auto own = new_plane(tile_row, tile);
    const Plane* earlier = task_.earlier.at(tiles(), tile_row, tile);
    if (earlier == nullptr) return own;
    const auto reused = at_best_distance(*earlier, tile_row, tile);
    if (!reused || !own) return reused ? reused : own;
    return 2 * run_held(*reused, tile_row, tile) >= run_held(*own, tile_row, tile) ? reused : own;
  }
  int run_held(const TilePlane& plane, int tile_row, int tile) const {
    const PlaneTest test(samples_, plane.plane, tile_row);
    int held = 0;
    while (tile + held < tiles().across && test.holds(tile + held)) ++held;
    return held;
  }
  std::optional<TilePlane> at_best_distance(const Plane& earlier, int tile_row, int tile) const {
    const PlaneFrame frame = frame_of_tile(task_.rays, tiles(), tile_row, tile, 0, 0);
    const auto level = distance_level(frame, earlier, task_.step_m);
    if (!level) return std::nullopt;
    constexpr std::int32_t kMostShift = 8;  // what errors of the motion explain
    for (std::int32_t shift = 0; shift <= kMostShift; ++shift) {
      for (const std::int32_t shifted : {*level + shift, *level - shift}) {
        if (shifted < 1) continue;
        TilePlane plane;
        plane.reused = true;
        plane.levels = {shifted, 0, 0};
        plane.plane = plane_at_distance(frame, earlier, shifted, task_.step_m);
        if (PlaneTest(samples_, plane.plane, tile_row).holds(tile)) return plane;
      }
    }
    return std::nullopt;
  }

  // The plane through a tile and what goes on from it, to the right and downwards.
  std::optional<TilePlane> new_plane(int tile_row, int tile) {
    PlaneMoments sums = samples_.moments(tile_row, tile);
    const Plane own = sums.fit();
    if (!PlaneTest(samples_, own, tile_row).holds(tile)) return std::nullopt;
    Plane plane = own;
    int end = tile + 1;
    grow_right(tile_row, tile, end, sums, plane);
    const int height = grow_down(tile_row, tile, end, sums, plane);
    if (auto coded =
            quantised(plane, tile_row, tile, end, extent_class(end - tile), extent_class(2 * height - 1)))
      return coded;
    return quantised(own, tile_row, tile, tile + 1, 0, 0);
  }

  // Keeps the plane while it holds the next tile, and fits it anew over all of them when it does not.
  void grow_right(int tile_row, int first, int& end, PlaneMoments& sums, Plane& plane) {
    PlaneTest test(samples_, plane, tile_row);
    for (; end < tiles().across; ++end) {
      PlaneMoments grown = sums;
      grown += samples_.moments(tile_row, end);
      if (!test.holds(end)) {
        const Plane refitted = grown.fit();
        const PlaneTest refitted_test(samples_, refitted, tile_row);
        if (!refitted_test.holds(first, end + 1)) break;
        plane = refitted;
        test = refitted_test;
      }
      sums = grown;
    }
    const Plane all = sums.fit();
    if (PlaneTest(samples_, all, tile_row).holds(first, end)) plane = all;
  }

  // Rows of tiles, the first included, most of which the plane holds; it is fitted over those, too.
  int grow_down(int tile_row, int first, int end, PlaneMoments& sums, Plane& plane) {
    constexpr int kMostHeight = 8;
    int height = 1;
    for (; height < kMostHeight && tile_row + height < tiles().down; ++height) {
      const PlaneTest test(samples_, plane, tile_row + height);
      PlaneMoments grown = sums;
      int held = 0;
      for (int tile = first; tile < end; ++tile) {
        if (!test.holds(tile)) continue;
        grown += samples_.moments(tile_row + height, tile);
        ++held;
      }
      if (2 * held < end - first) break;
      sums = grown;
      const Plane refitted = sums.fit();
      if (PlaneTest(samples_, refitted, tile_row).holds(first, end)) plane = refitted;
    }
    return height;
  }

  // Extents count from the middle of the first tile.
  static int extent_class(int half_tiles) {
    return std::min(kExtentClasses, static_cast<int>(std::bit_width(static_cast<unsigned>(half_tiles)))) - 1;
  }

  // Of the eight ways to round its levels, that which holds most tiles from the first on.
  std::optional<TilePlane> quantised(const Plane& plane, int tile_row, int first, int end, int width,
                                     int height) const {
    const PlaneFrame frame = frame_of_tile(task_.rays, tiles(), tile_row, first, width, height);
    const auto nearest = levels_of_plane(frame, plane, task_.step_m);
    if (!nearest) return std::nullopt;
    const PlaneLevels other = second_nearest(frame, plane, *nearest);
    TilePlane coded;
    coded.width = static_cast<std::uint8_t>(width);
    coded.height = static_cast<std::uint8_t>(height);
    std::optional<TilePlane> best;
    int most = 0;
    for (int choice = 0; choice < 8 && most < end - first; ++choice) {
      for (std::size_t i = 0; i < 3; ++i) coded.levels[i] = (choice >> i & 1) != 0 ? other[i] : (*nearest)[i];
      coded.plane = plane_from_levels(frame, coded.levels, task_.step_m);
      const PlaneTest test(samples_, coded.plane, tile_row);
      int held = 0;
      while (first + held < end && test.holds(first + held)) ++held;
      if (held <= most) continue;
      most = held;
      best = coded;
    }
    return best;
  }
  PlaneLevels second_nearest(const PlaneFrame& frame, const Plane& plane, const PlaneLevels& nearest) const {
    constexpr std::int32_t kFiner = 16;  // tells on which side of its level the plane is
    const auto fine = levels_of_plane(frame, plane, task_.step_m / kFiner);
    PlaneLevels other = nearest;
    for (std::size_t i = 0; i < other.size(); ++i)
      other[i] += fine && (*fine)[i] > kFiner * nearest[i] ? 1 : -1;
    other[0] = std::max(other[0], 1);
    return other;
  }

  const PlaneTask& task_;
  TileSamples samples_;
  PlaneTiles planes_;
};

}  // namespace

PlaneTiles find_planes(const PlaneTask& task) {
  return Search(task).run();
}

}  // namespace pointreel
