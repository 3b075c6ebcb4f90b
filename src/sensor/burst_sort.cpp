#include "sensor/burst_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

#include "entropy/adaptive_models.h"
#include "sensor/row_assignment.h"

namespace pointreel {
namespace {

// An element: its burst in the upper half, which alone is compared, and its place.
using Element = std::uint64_t;

bool is_earlier(Element a, Element b) {
  return (a >> 32) < (b >> 32);
}

// libstdc++'s introsort (bits/stl_algo.h of GCC 12): quicksort around the median of three, left alone below
// 17 elements, then insertion. Where it would give quicksort up for heapsort, which bursts in sequence do not
// bring about, the sort here is stable.
class Introsort {
 public:
  static void sort(std::span<Element> elements) {
    if (elements.size() < 2) return;
    const int most_depth = 2 * (static_cast<int>(std::bit_width(elements.size())) - 1);
    part(elements.data(), elements.data() + elements.size(), most_depth);
    insert(elements);
  }

 private:
  static constexpr std::ptrdiff_t kSmall = 16;

  static void part(Element* first, Element* last, int depth) {
    while (last - first > kSmall) {
      if (depth == 0) {
        std::stable_sort(first, last, is_earlier);
        return;
      }
      --depth;
      move_median(first, first + 1, first + (last - first) / 2, last - 1);
      Element* cut = part_around(first, last);
      part(cut, last, depth);
      last = cut;
    }
  }

  static void move_median(Element* to, Element* a, Element* b, Element* c) {
    Element* median = a;
    if (is_earlier(*a, *b)) {
      median = is_earlier(*b, *c) ? b : is_earlier(*a, *c) ? c : a;
    } else {
      median = is_earlier(*a, *c) ? a : is_earlier(*b, *c) ? c : b;
    }
    std::swap(*to, *median);
  }

  // Around the first element, which stays. The median of three ends both searches.
  static Element* part_around(Element* pivot, Element* last) {
    Element* first = pivot + 1;
    for (;;) {
      while (is_earlier(*first, *pivot)) ++first;
      --last;
      while (is_earlier(*pivot, *last)) --last;
      if (first >= last) return first;
      std::swap(*first, *last);
      ++first;
    }
  }

  // Stable, by now over short ways.
  static void insert(std::span<Element> elements) {
    for (std::size_t i = 1; i < elements.size(); ++i) {
      const Element inserted = elements[i];
      std::size_t place = i;
      for (; place > 0 && is_earlier(inserted, elements[place - 1]); --place)
        elements[place] = elements[place - 1];
      elements[place] = inserted;
    }
  }
};

// Runs of equal values, if they never fall; empty when they do, or are all one or all different.
template <class Value>
std::vector<std::uint32_t> rising_runs(const std::vector<Value>& values) {
  std::vector<std::uint32_t> sizes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && !(values[i - 1] <= values[i])) return {};
    if (i > 0 && values[i - 1] == values[i])
      ++sizes.back();
    else
      sizes.push_back(1);
  }
  if (sizes.size() < 2 || sizes.size() == values.size()) return {};
  return sizes;
}

// What stands for the rows of the points: their rings, or how high they are seen.
std::vector<std::uint8_t> row_like(const PointCloud& cloud) {
  std::vector<std::uint8_t> rows(cloud.size());
  const auto rings = ring_values(cloud);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rings.empty()) {
      rows[i] = static_cast<std::uint8_t>(rings[i]);
      continue;
    }
    const Point3f& p = cloud.positions[i];
    constexpr float kSteepest = 0.79F;
    const float slope = p.z / std::max(std::sqrt(p.x * p.x + p.y * p.y), 1e-3F);
    const float shown = slope > kSteepest ? kSteepest : slope > -kSteepest ? slope : -kSteepest;  // NaN, too
    rows[i] = static_cast<std::uint8_t>(128 + shown * 160);
  }
  return rows;
}

// How many points have the row that most often comes after the row before them.
std::uint64_t points_as_usual(const std::vector<std::uint8_t>& rows,
                              std::span<const std::uint32_t> sequence) {
  std::vector<std::array<std::uint32_t, 256>> next(256, std::array<std::uint32_t, 256>{});
  for (std::size_t i = 1; i < sequence.size(); ++i) ++next[rows[sequence[i - 1]]][rows[sequence[i]]];
  std::uint64_t usual = 0;
  for (const auto& counts : next) usual += *std::max_element(counts.begin(), counts.end());
  return usual;
}

// New element i is the old one `from[i]`.
void rearrange(PointCloud& cloud, std::span<const std::uint32_t> from) {
  const auto taken = [&](auto& values) {
    auto old = values;
    for (std::size_t i = 0; i < from.size(); ++i) values[i] = old[from[i]];
  };
  taken(cloud.positions);
  for (Field& field : cloud.fields) std::visit(taken, field.values);
}

std::vector<std::uint32_t> inverse(std::span<const std::uint32_t> places) {
  std::vector<std::uint32_t> inverted(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) inverted[places[i]] = static_cast<std::uint32_t>(i);
  return inverted;
}

// Where the next burst is expected: as many columns ahead as the last one was long, at the same place within
// the round of the lasers; or else after as many points.
class BurstPrediction {
 public:
  explicit BurstPrediction(const FiringPlaces& places) : places_(places) {
    for (std::size_t i = 0; i < places.of_point.size(); ++i) {
      const std::int32_t place = places.of_point[i];
      if (place < 0) continue;
      const auto slot = static_cast<std::size_t>(place / places.rows);
      if (slot >= first_of_slot_.size()) first_of_slot_.resize(slot + 1, kNone);
      if (first_of_slot_[slot] == kNone) first_of_slot_[slot] = static_cast<std::int64_t>(i);
    }
  }

  std::int64_t next_start() const {
    const std::int64_t target = border_ + step_;
    const auto count = static_cast<std::int64_t>(places_.of_point.size());
    const std::int64_t slot = target / places_.rows;
    if (target >= 0 && slot < static_cast<std::int64_t>(first_of_slot_.size()) &&
        first_of_slot_[static_cast<std::size_t>(slot)] != kNone) {
      std::int64_t next = first_of_slot_[static_cast<std::size_t>(slot)];
      const std::int64_t end = std::min(count, next + places_.rows);
      while (next < end && place(next) < target) ++next;
      if (next > start_) return next;
    }
    return std::min(count, start_ + size_);
  }

  void update(std::int64_t start) {
    size_ = start - start_;
    start_ = start;
    if (start >= static_cast<std::int64_t>(places_.of_point.size())) return;
    const std::int64_t last = place(start - 1);
    const std::int64_t first = place(start);
    if (last < 0 || first < 0) return;
    const std::int64_t border_before = border_;
    // Lasers without a return leave open where between the two the border is: what all bursts so far allow.
    border_ += (last - border_ + places_.rows) / places_.rows * places_.rows;
    least_ = std::max(least_, last - border_);
    most_ = std::min(most_, first - border_);
    if (least_ >= most_) {
      border_ = first;
      least_ = last - first;
      most_ = 0;
    } else if (most_ < 0 || least_ >= 0) {
      border_ += most_;
      least_ -= most_;
      most_ = 0;
    }
    step_ = border_ - border_before;
  }

 private:
  static constexpr std::int64_t kNone = -1;
  std::int64_t place(std::int64_t point) const { return places_.of_point[static_cast<std::size_t>(point)]; }

  const FiringPlaces& places_;
  std::vector<std::int64_t> first_of_slot_;  // the first point of each column
  std::int64_t start_ = 0, size_ = 1;        // of the last burst
  std::int64_t border_ = 0, step_ = 0;       // its place, and how far that is from the one before
  std::int64_t least_ = -(std::int64_t{1} << 40),
               most_ = std::int64_t{1} << 40;  // beyond and up to, from border_
};

template <class Coder>
bool code_bursts(Coder& coder, const FiringPlaces& places, std::vector<std::uint32_t>& sizes) {
  BurstPrediction prediction(places);
  AdaptiveInteger model;
  const auto count = static_cast<std::int64_t>(places.of_point.size());
  std::int64_t start = 0;
  for (std::size_t burst = 0; start < count; ++burst) {
    const std::int64_t size = burst < sizes.size() ? sizes[burst] : 0;
    const std::int64_t predicted = prediction.next_start();
    const std::int64_t next =
        predicted + model.code(coder, static_cast<std::int32_t>(start + size - predicted));
    if (next <= start || next > count) return false;
    if (burst >= sizes.size()) sizes.push_back(static_cast<std::uint32_t>(next - start));
    prediction.update(next);
    start = next;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> places_before_sort(std::span<const std::uint32_t> burst_sizes) {
  std::vector<Element> elements;
  for (std::size_t burst = 0; burst < burst_sizes.size(); ++burst) {
    for (std::uint32_t k = 0; k < burst_sizes[burst]; ++k)
      elements.push_back((static_cast<Element>(burst) << 32) | elements.size());
  }
  Introsort::sort(elements);
  std::vector<std::uint32_t> places(elements.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = static_cast<std::uint32_t>(elements[i]);
  return places;
}

std::vector<std::uint32_t> undo_sort(PointCloud& cloud) {
  for (const Field& field : cloud.fields) {
    auto sizes = std::visit([](const auto& values) { return rising_runs(values); }, field.values);
    if (sizes.empty()) continue;
    const auto places = places_before_sort(sizes);
    const auto from = inverse(places);
    // Regular as it is, the cloud stays: rows that were sorted by their rings, say.
    const auto rows = row_like(cloud);
    std::vector<std::uint32_t> as_is(cloud.size());
    for (std::size_t i = 0; i < as_is.size(); ++i) as_is[i] = static_cast<std::uint32_t>(i);
    if (points_as_usual(rows, from) * 8 < points_as_usual(rows, as_is) * 9) continue;
    rearrange(cloud, from);
    return sizes;
  }
  return {};
}

void redo_sort(std::span<const std::uint32_t> burst_sizes, PointCloud& cloud) {
  rearrange(cloud, places_before_sort(burst_sizes));
}

std::vector<std::uint8_t> encode_bursts(std::span<const std::uint32_t> burst_sizes,
                                        const FiringPlaces& places) {
  BitEncoder coder;
  std::vector<std::uint32_t> sizes(burst_sizes.begin(), burst_sizes.end());
  code_bursts(coder, places, sizes);
  return coder.finish();
}

Result<std::vector<std::uint32_t>> decode_bursts(const FiringPlaces& places,
                                                 std::span<const std::uint8_t> bytes) {
  BitDecoder coder(bytes);
  std::vector<std::uint32_t> sizes;
  if (!code_bursts(coder, places, sizes)) return Error{ErrorCode::corrupt, "a burst of points has no place"};
  if (coder.overran()) return Error{ErrorCode::truncated, "the bursts of points end early"};
  return sizes;
}

}  // namespace pointreel
