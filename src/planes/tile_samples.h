// TileSamples: a sweep as the search for planes takes it, tile by tile.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "base/raw_vector.h"
#include "planes/plane_search.h"

namespace pointreel {

class TileSamples {
 public:
  explicit TileSamples(const PlaneTask& task);

  const TileGrid& tiles() const { return tiles_; }
  bool has_returns(int tile_row, int tile) const;
  // Of the returns of a tile, summed when first asked for.
  const PlaneMoments& moments(int tile_row, int tile);

  // A plane as the rows of one row of tiles see it.
  class PlaneTest {
   public:
    PlaneTest(const TileSamples& samples, const Plane& plane, int tile_row) : samples_(&samples) {
      const int end = samples.tiles_.end_row(tile_row);
      for (int row = TileGrid::first_row(tile_row); row < end; ++row)
        rows_[count_++] = {samples.rays_.row_plane(plane, row), samples.first_cell(row)};
    }
    // All returns of the tile are within their tolerances.
    bool holds(int tile) const {
      for (std::size_t r = 0; r < count_; ++r) {
        const SensorRays::RowPlane& at = rows_[r].plane;
        const std::size_t cell = rows_[r].first_cell + static_cast<std::size_t>(tile * kTileColumns);
        const Row cosine = row_of(samples_->cos_, cell), sine = row_of(samples_->sin_, cell);
        const Row denominator = at.along * cosine + at.across * sine + at.up;
        const Row numerator = at.at_zero + at.side_offset_m * (at.along * sine - at.across * cosine);
        const Row off = (numerator - row_of(samples_->rho_m_, cell) * denominator).abs();
        if (!(off <= row_of(samples_->tolerance_m_, cell) * denominator).all()) return false;
      }
      return true;
    }
    bool holds(int first, int end) const {
      for (int tile = first; tile < end; ++tile) {
        if (!holds(tile)) return false;
      }
      return true;
    }

   private:
    struct InRow {
      SensorRays::RowPlane plane;
      std::size_t first_cell;
    };
    const TileSamples* samples_;
    std::array<InRow, kTileRows> rows_{};
    std::size_t count_ = 0;
  };

 private:
  using Row = Eigen::Array<float, kTileColumns, 1>;

  // Rows are padded to whole tiles by cells without a return.
  std::size_t first_cell(int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles_.across * kTileColumns);
  }
  static Eigen::Map<const Row> row_of(const RawVector<float>& values, std::size_t cell) {
    return Eigen::Map<const Row>(&values[cell]);
  }

  const SensorRays& rays_;
  TileGrid tiles_;
  RawVector<float> rho_m_, tolerance_m_;  // horizontal; tolerance without a return: any
  RawVector<float> cos_, sin_;            // of the column azimuths
  std::vector<std::uint8_t> has_moments_;
  RawVector<PlaneMoments> moments_;
};

}  // namespace pointreel
