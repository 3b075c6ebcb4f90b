#include "scatter/stray_list.h"

#include <optional>

#include "entropy/adaptive_models.h"
#include "entropy/wide_integer.h"
#include "scatter/lattice.h"

namespace pointreel {
namespace {

enum class StrayKind : std::uint8_t {
  repeat,  // where the one before it is
  origin,  // in the lattice's cell around (0, 0, 0): how many sensors mark a missing return
  moved,   // by its cell's distance from the latest one that was moved
  raw,
};

// One stray in the terms of the code.
struct CodedStray {
  std::uint64_t gap = 0;  // indices left out since the one before
  StrayKind kind = StrayKind::raw;
  LatticeCell cell{};
  RawPoint raw{};
};

class StrayCoder {
 public:
  template <class Coder>
  void code(Coder& coder, CodedStray& stray) {
    // Gaps repeat where every n-th point is missing.
    if (coder.code(gap_repeats_[gap_repeated_], stray.gap == gap_)) {
      stray.gap = gap_;
      gap_repeated_ = 1;
    } else {
      gap_ = stray.gap = gaps_.code(coder, stray.gap);
      gap_repeated_ = 0;
    }

    auto& kinds = kinds_[static_cast<std::size_t>(kind_)];
    const unsigned wanted = static_cast<unsigned>(stray.kind);
    const unsigned high = coder.code(kinds[0], (wanted >> 1) != 0) ? 1u : 0u;
    const unsigned low = coder.code(kinds[1 + high], (wanted & 1u) != 0) ? 1u : 0u;
    stray.kind = static_cast<StrayKind>(2 * high + low);
    if (stray.kind == StrayKind::repeat) return;
    kind_ = stray.kind;

    if (stray.kind == StrayKind::moved) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Wraps around in 32 bits, so that any bytes give some cell.
        const std::int64_t distance = std::int64_t{stray.cell[axis]} - cell_[axis];
        const std::uint64_t coded =
            distances_[axis].code(coder, zigzag(static_cast<std::uint64_t>(distance)));
        const auto moved =
            static_cast<std::uint32_t>(cell_[axis]) + static_cast<std::uint32_t>(unzigzag(coded));
        stray.cell[axis] = cell_[axis] = static_cast<std::int32_t>(moved);
      }
    } else if (stray.kind == StrayKind::raw) {
      code_raw_point(coder, stray.raw);
    }
  }

 private:
  std::array<AdaptiveBit, 2> gap_repeats_;
  std::size_t gap_repeated_ = 0;
  std::uint64_t gap_ = 0;
  AdaptiveWideInteger gaps_{6};
  std::array<std::array<AdaptiveBit, 3>, 4> kinds_;
  StrayKind kind_ = StrayKind::repeat;  // the latest that was none
  LatticeCell cell_{};
  std::array<AdaptiveWideInteger, 3> distances_ = {AdaptiveWideInteger(6), AdaptiveWideInteger(6),
                                                   AdaptiveWideInteger(6)};
};

template <class Coder>
std::uint64_t code_count(Coder& coder, std::uint64_t count) {
  AdaptiveWideInteger model(0);
  return model.code(coder, count);
}

}  // namespace

std::vector<std::uint8_t> encode_strays(std::span<const Stray> strays, double max_error_m) {
  std::vector<Point3f> positions;
  positions.reserve(strays.size());
  for (const Stray& stray : strays) positions.push_back(stray.position);
  const int shrink = Lattice::shrink_for(positions, max_error_m);
  const Lattice lattice(max_error_m, shrink);

  BitEncoder coder;
  code_count(coder, strays.size());
  if (strays.empty()) return coder.finish();
  code_plain_bits(coder, static_cast<std::uint64_t>(shrink), 5);
  StrayCoder model;
  std::uint64_t next = 0;
  std::optional<LatticeCell> cell_before;
  RawPoint raw_before{};
  for (std::size_t i = 0; i < strays.size(); ++i) {
    CodedStray stray;
    stray.gap = strays[i].index - next;
    next = strays[i].index + std::uint64_t{1};
    stray.raw = raw_bits(strays[i].position);
    const auto cell = lattice.cell_of(strays[i].position);
    if (i > 0 && cell == cell_before && (cell || stray.raw == raw_before)) {
      stray.kind = StrayKind::repeat;
    } else if (cell) {
      stray.cell = *cell;
      stray.kind = *cell == LatticeCell{} ? StrayKind::origin : StrayKind::moved;
    }
    cell_before = cell;
    raw_before = stray.raw;
    model.code(coder, stray);
  }
  return coder.finish();
}

Result<std::vector<Stray>> decode_strays(std::span<const std::uint8_t> bytes, double max_error_m,
                                         std::size_t points_limit) {
  BitDecoder coder(bytes);
  const std::uint64_t count = code_count(coder, 0);
  if (count > points_limit) return Error{ErrorCode::corrupt, "more strays than points"};
  std::vector<Stray> strays;
  if (count == 0) return strays;
  const int shrink = static_cast<int>(code_plain_bits(coder, 0, 5));
  if (shrink == 0) return Error{ErrorCode::corrupt, "the strays' lattice has no edge"};
  const Lattice lattice(max_error_m, shrink);
  StrayCoder model;
  std::uint64_t next = 0;
  Point3f position;
  for (std::uint64_t i = 0; i < count; ++i) {
    CodedStray stray;
    model.code(coder, stray);
    if (coder.overran())
      return Error{ErrorCode::truncated, "the bytes of the strays end before the last one"};
    if (next >= points_limit || stray.gap >= points_limit - next) {
      return Error{ErrorCode::corrupt, "a stray beyond the last point"};
    }
    if (stray.kind == StrayKind::raw) position = point_from(stray.raw);
    if (stray.kind == StrayKind::origin || stray.kind == StrayKind::moved)
      position = lattice.position(stray.cell);
    strays.push_back({static_cast<std::uint32_t>(next + stray.gap), position});
    next += stray.gap + 1;
  }
  return strays;
}

}  // namespace pointreel
