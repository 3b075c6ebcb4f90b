// TileSamples: a sweep as the search for planes takes it, tile by tile.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/raw_vector.h"
#include "planes/plane_search.h"
#include "planes/tile_tests.h"

namespace pointreel {

class TileSamples {
  struct Loops;

 public:
  explicit TileSamples(const PlaneTask& task);

  const TileGrid& tiles() const { return tiles_; }
  int returns(int tile_row, int tile) const;
  // No plane holds the tile: along a row its returns bend more than their tolerances explain.
  bool bends(int tile_row, int tile) const;
  // Of the returns of a tile, summed when first asked for.
  const PlaneMoments& moments(int tile_row, int tile);

  // A plane as the rows of one row of tiles see it.
  class PlaneTest {
   public:
    PlaneTest(const TileSamples& samples, const Plane& plane, int tile_row) {
      const int end = samples.tiles_.end_row(tile_row);
      for (int row = TileGrid::first_row(tile_row); row < end; ++row)
        rows_[count_++] = {samples.rays_.row_plane(plane, row), samples.cells(row)};
    }
    // All returns of the tile are within their tolerances.
    bool holds(int tile) const {
      return tile_holds(std::span(rows_).first(count_), static_cast<std::size_t>(tile) * kTileColumns);
    }
    bool holds(int first, int end) const;

   private:
    std::array<PlaneInRow, kTileRows> rows_{};
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

  RowCells cells(int row) const {
    const std::size_t first = first_cell(row);
    return {rays_.cos_of_row(row), rays_.sin_of_row(row), &rho_m_[first], &tolerance_m_[first],
            &per_rho_m_[first]};
  }

  const SensorRays& rays_;
  TileGrid tiles_;
  RawVector<float> rho_m_, tolerance_m_, per_rho_m_;  // horizontal; RowCells
  std::vector<std::uint8_t> has_moments_;
  RawVector<PlaneMoments> moments_;
};

}  // namespace pointreel
