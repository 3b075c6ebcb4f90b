// Where the points of a sweep lie, as both sides know it before any field is coded: what fields are predicted
// from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pointreel {

// Geometry that both sides know. One entry a point, in the order of the output cloud.
struct FieldContext {
  // The sensor grid: rows top down, equal columns look in equal directions. Both 0 when the cloud has none.
  std::uint32_t rows = 0, columns = 0;
  std::span<const std::int32_t>
      cell_of_point;               // row * columns + column; -1 (or outside): a point off the grid
  std::span<const float> range_m;  // as decoded, for it takes part in the decoder's contexts
};

// The points in raster order of their cells, then those off the grid. Made once a sweep, used for every
// field.
class PointLayout {
 public:
  explicit PointLayout(const FieldContext& context);

  // A point's place: the row below the grid is that of the points off the grid, all of them in column 0.
  struct Place {
    std::uint32_t point;  // in the output's order
    std::uint32_t row, column;
    float range_m;
  };

  std::size_t size() const { return places_.size(); }
  std::uint32_t rows() const { return rows_; }        // with the one below the grid
  std::uint32_t columns() const { return columns_; }  // at least 1
  std::span<const Place> raster() const { return places_; }

 private:
  std::uint32_t rows_, columns_;
  std::vector<Place> places_;
};

}  // namespace pointreel
