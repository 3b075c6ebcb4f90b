#include "codec/point_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "codec/corrections.h"

namespace pointreel {
namespace {

using Cube = std::array<std::int64_t, 3>;
struct CubeHash {
  std::size_t operator()(const Cube& cube) const {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cube) hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

// Decoded points by cubes of the bound's size.
class Cubes {
 public:
  Cubes(std::span<const Point3f> points, double edge_m) : points_(points), edge_m_(edge_m) {
    for (std::size_t i = 0; i < points.size(); ++i)
      cubes_[cube_of(points[i])].push_back(static_cast<std::int64_t>(i));
  }
  // All within the edge of `p`, nearest first.
  std::vector<std::int64_t> near(const Point3f& p) const {
    std::vector<std::pair<double, std::int64_t>> found;
    const Cube middle = cube_of(p);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto cube = cubes_.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (cube == cubes_.end()) continue;
          for (const std::int64_t i : cube->second) {
            const double distance = distance_m(points_[static_cast<std::size_t>(i)], p);
            if (distance <= edge_m_) found.emplace_back(distance, i);
          }
        }
      }
    }
    std::sort(found.begin(), found.end());
    std::vector<std::int64_t> indices;
    indices.reserve(found.size());
    for (const auto& [distance, i] : found) indices.push_back(i);
    return indices;
  }

 private:
  Cube cube_of(const Point3f& p) const {
    const auto index = [this](float x) {
      return static_cast<std::int64_t>(std::clamp(std::floor(static_cast<double>(x) / edge_m_), -4e18, 4e18));
    };
    return {index(p.x), index(p.y), index(p.z)};
  }
  std::span<const Point3f> points_;
  double edge_m_;
  std::unordered_map<Cube, std::vector<std::int64_t>, CubeHash> cubes_;
};

}  // namespace

// Greedy, then augmenting paths (breadth first) for the points that were left without a partner.
std::vector<std::int64_t> match_points(std::span<const Point3f> originals, std::span<const Point3f> decoded,
                                       double max_error_m) {
  const Cubes cubes(decoded, max_error_m);
  std::vector<std::int64_t> partner_of_original(originals.size(), -1), partner_of_decoded(decoded.size(), -1);
  std::vector<std::size_t> left_over;
  for (std::size_t i = 0; i < originals.size(); ++i) {
    if (!is_finite(originals[i])) continue;
    for (const std::int64_t d : cubes.near(originals[i])) {
      if (partner_of_decoded[static_cast<std::size_t>(d)] >= 0) continue;
      partner_of_decoded[static_cast<std::size_t>(d)] = static_cast<std::int64_t>(i);
      partner_of_original[i] = d;
      break;
    }
    if (partner_of_original[i] < 0) left_over.push_back(i);
  }
  std::vector<std::size_t> seen_in(decoded.size(), 0);  // number of the search that saw it
  std::vector<std::int64_t> reached_from(decoded.size(), -1);
  std::size_t search = 0;
  for (const std::size_t start : left_over) {
    ++search;
    std::vector<std::int64_t> queue = {static_cast<std::int64_t>(start)};
    std::int64_t free = -1;
    for (std::size_t at = 0; at < queue.size() && free < 0; ++at) {
      const std::int64_t original = queue[at];
      for (const std::int64_t d : cubes.near(originals[static_cast<std::size_t>(original)])) {
        const auto index = static_cast<std::size_t>(d);
        if (seen_in[index] == search) continue;
        seen_in[index] = search;
        reached_from[index] = original;
        if (partner_of_decoded[index] < 0) {
          free = d;
          break;
        }
        queue.push_back(partner_of_decoded[index]);
      }
    }
    while (free >= 0) {
      const std::int64_t original = reached_from[static_cast<std::size_t>(free)];
      const std::int64_t before = partner_of_original[static_cast<std::size_t>(original)];
      partner_of_decoded[static_cast<std::size_t>(free)] = original;
      partner_of_original[static_cast<std::size_t>(original)] = free;
      free = before;
    }
  }
  return partner_of_original;
}

}  // namespace pointreel
