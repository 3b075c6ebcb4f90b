// How a rendered canvas becomes an image, eight cells at once.

#if defined(POINTREEL_PREDICT_WARP_CANVAS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_WARP_CANVAS_INL_H_
#undef POINTREEL_PREDICT_WARP_CANVAS_INL_H_
#else
#define POINTREEL_PREDICT_WARP_CANVAS_INL_H_
#endif

#include <utility>

#include "base/lanes-inl.h"
#include "predict/warp_canvas.h"
#include "predict/warped_points.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

inline void average(int row, WarpCanvas& canvas) {
  const auto first = static_cast<std::size_t>(canvas.first_of_row(row));
  const auto columns = static_cast<std::size_t>(canvas.columns);
  for (std::size_t cell = first; cell < first + columns; cell += 8) {
    const Float8 weight = load<8>(&canvas.weight[cell]);
    const Mask<8> any_point = all<8>(0) < weight;
    const Float8 mean_m = load<8>(&canvas.range_m[cell]) / select(any_point, weight, all<8>(1));
    store(where(any_point, mean_m), &canvas.range_m[cell]);
  }
  // Around the turn, as often as it takes.
  constexpr std::size_t kMargin = WarpCanvas::kMargin;
  for (std::size_t i = 0; i < kMargin; ++i) {
    for (const auto& [to, from] : {std::pair(first + columns + i, first + i % columns),
                                   std::pair(first - 1 - i, first + columns - 1 - i % columns)}) {
      canvas.range_m[to] = canvas.range_m[from];
      canvas.sides[to] = canvas.sides[from];
    }
  }
}

// A cell beside holes: what it says about the one towards which its surface goes on.
struct Neighbour {
  Float8 range_m;
  Mask<8> goes_on;

  POINTREEL_INLINE Neighbour(const WarpCanvas& canvas, std::size_t cell, SurfaceSide towards)
      : range_m(load<8>(&canvas.range_m[cell])) {
    const Int8 bit = load_ints<8>(&canvas.sides[cell]) & all_ints<8>(towards);
    goes_on = (all<8>(0) < range_m) & as_float_mask(bit > all_ints<8>(0));
  }
};

// Between two neighbours on one surface, along which 1 / range is linear.
struct Between {
  Float8 range_m;
  Mask<8> known;

  POINTREEL_INLINE Between(const Neighbour& a, const Neighbour& b) {
    const Float8 sum_m = a.range_m + b.range_m;
    known = a.goes_on & b.goes_on & (absolute(a.range_m - b.range_m) <= 0.03F * sum_m + all<8>(0.6F));
    range_m = 2.0F * a.range_m * b.range_m / select(known, sum_m, all<8>(1));
  }
};

// The ranges of cells that no point fell into, where a surface goes on through them, rather to the sides than
// up and down; else 0.
POINTREEL_INLINE Float8 filled(const WarpCanvas& canvas, std::size_t cell) {
  const auto stride = static_cast<std::size_t>(canvas.stride);
  const Between across(Neighbour(canvas, cell - 1, kRight), Neighbour(canvas, cell + 1, kLeft));
  const Between down(Neighbour(canvas, cell - stride, kBelow), Neighbour(canvas, cell + stride, kAbove));
  return select(across.known, across.range_m, where(down.known, down.range_m));
}

// Of the reference, in the same cells.
POINTREEL_INLINE Mask<8> returned_before(const ReturnsBefore& before, std::size_t column) {
  const Int8 none = all_ints<8>(-1), in_sensor = load_ints<8>(&before.columns[column]);
  const Int8 width = all_ints<8>(static_cast<std::int32_t>(before.range_m.size()));
  const Int8 turned = in_sensor + all_ints<8>(before.shift);
  const Int8 in_image = turned - where(turned > width - all_ints<8>(1), width);
  const IntMask<8> known = in_sensor > none;
  const Float8 range_m = gather(before.range_m.data(), where(known, in_image));
  return as_float_mask(known) & (all<8>(0) < range_m);
}

inline void finish(const WarpCanvas& canvas, int row, const ReturnsBefore& before, ReferenceImage& image) {
  const auto first = static_cast<std::size_t>(canvas.first_of_row(row));
  const auto columns = static_cast<std::size_t>(canvas.columns);
  float* range_to = &image.range_m[image.index(row, 0)];
  std::uint8_t* hits_to = &image.hits[image.index(row, 0)];
  for (std::size_t c = 0; c < columns; c += 8) {
    const Float8 rendered_m = load<8>(&canvas.range_m[first + c]);
    const Mask<8> hit = all<8>(0) < rendered_m;
    const Float8 filled_m = filled(canvas, first + c);
    const Int8 holes = where(as_int_mask(all<8>(0) < filled_m), all_ints<8>(kWarpedFilled));
    const Int8 hits = select(as_int_mask(hit), all_ints<8>(kWarpedHit), holes) |
                      where(as_int_mask(returned_before(before, c)), all_ints<8>(kPreviousHit));
    store_first(select(hit, rendered_m, filled_m), range_to + c, columns - c);
    store_first_bytes(hits, hits_to + c, columns - c);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
