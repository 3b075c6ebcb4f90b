#include "scatter/scattered_points.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "entropy/wide_integer.h"
#include "scatter/lattice.h"
#include "scatter/octree_coding.h"

namespace pointreel {
namespace {

constexpr std::int32_t kMaxSpan = 1 << kMaxOctreeDepth;

// What the bytes begin with.
struct ScatterHeader {
  std::uint64_t on_lattice = 0;  // distinct cells: whether there are any is all that a decoder uses
  std::uint64_t raw = 0;         // points as they are
  std::uint64_t shrink = 1;
  std::uint64_t depth = 0;
  LatticeCell origin{};  // of the octree
};

template <class Coder>
void code_header(Coder& coder, ScatterHeader& header) {
  AdaptiveWideInteger raw(0);
  header.raw = raw.code(coder, header.raw);
  header.on_lattice = coder.code_even(header.on_lattice != 0);
  if (header.on_lattice == 0) return;
  header.shrink = code_plain_bits(coder, header.shrink, 5);
  header.depth = code_plain_bits(coder, header.depth, 5);
  for (std::int32_t& index : header.origin) {
    index = static_cast<std::int32_t>(code_plain_bits(coder, static_cast<std::uint32_t>(index), 32));
  }
}

// Least cell of the octree, and its depth. The few cells outside stay off it: only a cloud wider than 2^21
// cells has any.
void place_octree(std::span<const std::optional<LatticeCell>> cells, ScatterHeader& header) {
  LatticeCell least{}, most{};
  bool first = true;
  for (const auto& cell : cells) {
    if (!cell) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = first ? (*cell)[axis] : std::min(least[axis], (*cell)[axis]);
      most[axis] = first ? (*cell)[axis] : std::max(most[axis], (*cell)[axis]);
    }
    first = false;
  }
  std::uint32_t span = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Too wide: the cube around the sensor.
    if (std::int64_t{most[axis]} - least[axis] >= kMaxSpan) {
      least[axis] = -kMaxSpan / 2;
      most[axis] = kMaxSpan / 2 - 1;
    }
    span = std::max(span, static_cast<std::uint32_t>(most[axis] - least[axis]));
  }
  header.origin = least;
  header.depth = static_cast<std::uint64_t>(std::bit_width(span));
}

std::optional<std::uint64_t> octree_key(const LatticeCell& cell, const ScatterHeader& header) {
  std::array<std::uint32_t, 3> offset{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t distance = std::int64_t{cell[axis]} - header.origin[axis];
    if (distance < 0 || distance >= std::int64_t{1} << header.depth) return std::nullopt;
    offset[axis] = static_cast<std::uint32_t>(distance);
  }
  return interleaved(offset[0], offset[1], offset[2]);
}

LatticeCell cell_at(std::uint64_t key, const LatticeCell& origin) {
  LatticeCell cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Wraps around, so that any bytes give some cell.
    cell[axis] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(origin[axis]) + every_third_bit(key >> axis));
  }
  return cell;
}

}  // namespace

ScatteredPoints encode_scattered(std::span<const Point3f> points, double max_error_m) {
  ScatterHeader header;
  const int shrink = Lattice::shrink_for(points, max_error_m);
  header.shrink = static_cast<std::uint64_t>(shrink);
  const Lattice lattice(max_error_m, shrink);
  std::vector<std::optional<LatticeCell>> cells;
  cells.reserve(points.size());
  for (const Point3f& point : points) cells.push_back(lattice.cell_of(point));
  place_octree(cells, header);

  struct Keyed {
    std::uint64_t key;
    std::uint32_t index;
  };
  std::vector<Keyed> keyed;
  std::vector<std::uint32_t> raw;
  keyed.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto key = cells[i] ? octree_key(*cells[i], header) : std::nullopt;
    key ? keyed.push_back({*key, i}) : raw.push_back(i);
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  });

  ScatteredPoints result;
  result.order.reserve(points.size());
  std::vector<OctreeLeaf> leaves;
  for (const Keyed& point : keyed) {
    if (leaves.empty() || leaves.back().key != point.key) leaves.push_back({point.key, 0});
    ++leaves.back().count;
    result.order.push_back(point.index);
  }
  result.order.insert(result.order.end(), raw.begin(), raw.end());

  header.on_lattice = leaves.size();
  header.raw = raw.size();
  BitEncoder coder;
  code_header(coder, header);
  if (!leaves.empty()) code_octree(coder, static_cast<int>(header.depth), leaves, keyed.size());
  for (const std::uint32_t i : raw) {
    RawPoint bits = raw_bits(points[i]);
    code_raw_point(coder, bits);
  }
  result.bytes = coder.finish();
  return result;
}

Result<std::vector<Point3f>> decode_scattered(std::span<const std::uint8_t> bytes, double max_error_m,
                                              std::size_t points_limit) {
  BitDecoder coder(bytes);
  ScatterHeader header;
  code_header(coder, header);
  if (header.raw > points_limit || header.shrink == 0 || header.depth > kMaxOctreeDepth) {
    return Error{ErrorCode::corrupt, "the header of scattered points contradicts itself"};
  }
  const Lattice lattice(max_error_m, static_cast<int>(header.shrink));
  std::vector<OctreeLeaf> leaves;
  if (header.on_lattice != 0 && !code_octree(coder, static_cast<int>(header.depth), leaves,
                                             points_limit - static_cast<std::size_t>(header.raw))) {
    return coder.overran()
               ? Error{ErrorCode::truncated, "the bytes of scattered points end before the last one"}
               : Error{ErrorCode::corrupt, "more scattered points than there can be"};
  }
  std::vector<Point3f> points;
  for (const OctreeLeaf& leaf : leaves) {
    points.insert(points.end(), leaf.count, lattice.position(cell_at(leaf.key, header.origin)));
  }
  for (std::uint64_t i = 0; i < header.raw; ++i) {
    RawPoint raw{};
    code_raw_point(coder, raw);
    if (coder.overran())
      return Error{ErrorCode::truncated, "the bytes of scattered points end before the last one"};
    points.push_back(point_from(raw));
  }
  return points;
}

}  // namespace pointreel
