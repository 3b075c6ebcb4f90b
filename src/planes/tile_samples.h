// TileSamples: a sweep as the search for planes takes it, tile by tile.
#pragma once

#include <cstdint>
#include <vector>

#include "base/raw_vector.h"
#include "planes/plane_search.h"

namespace pointreel {

class TileSamples {
  struct Loops;

 public:
  explicit TileSamples(const PlaneTask& task);

  const TileGrid& tiles() const { return tiles_; }
  int returns(int tile_row, int tile) const;
  // Of the returns of a tile, summed when first asked for.
  const PlaneMoments& moments(int tile_row, int tile);

  // A plane as the rows of one row of tiles see it.
  class PlaneTest {
   public:
    PlaneTest(const TileSamples& samples, const Plane& plane, int tile_row) : samples_(&samples) {
      const int end = samples.tiles_.end_row(tile_row);
      for (int row = TileGrid::first_row(tile_row); row < end; ++row)
        rows_[count_++] = {samples.rays_.row_plane(plane, row), samples.first_cell(row),
                           samples.rays_.cos_of_row(row), samples.rays_.sin_of_row(row)};
    }
    // All returns of the tile are within their tolerances.
    bool holds(int tile) const;
    bool holds(int first, int end) const;

   private:
    friend struct Loops;
    struct InRow {
      SensorRays::RowPlane plane;
      std::size_t first_cell;
      const float *cosine, *sine;  // by column
    };
    const TileSamples* samples_;
    std::array<InRow, kTileRows> rows_{};
    std::size_t count_ = 0;
  };

 private:
  // Rows are padded to whole tiles by cells without a return.
  std::size_t first_cell(int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles_.across * kTileColumns);
  }
  std::size_t first_cell(int row, int tile) const {
    return first_cell(row) + static_cast<std::size_t>(tile * kTileColumns);
  }

  const SensorRays& rays_;
  TileGrid tiles_;
  RawVector<float> rho_m_, tolerance_m_;  // horizontal; tolerance without a return: any
  std::vector<std::uint8_t> has_moments_;
  RawVector<PlaneMoments> moments_;
};

}  // namespace pointreel
