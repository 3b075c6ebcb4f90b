#include "planes/tile_samples.h"

#include <array>

#include "base/simd_loops.h"

namespace pointreel {

TileSamples::TileSamples(const PlaneTask& task)
    : rays_(task.rays), tiles_(task.rays.rows(), task.rays.columns()) {
  // Of the range: what is left of the tolerance after its rounding to float32, which the test has, too.
  constexpr float kRounding = 5e-7F;
  const std::size_t padded = first_cell(tiles_.rows), read = padded + kCellsBeyond;
  rho_m_.resize(read);
  tolerance_m_.resize(read);
  per_rho_m_.resize(read);
  has_moments_.resize(tiles_.count());
  moments_.resize(tiles_.count());
  const auto columns = static_cast<std::size_t>(tiles_.columns);
  for (int row = 0; row < tiles_.rows; ++row) {
    const std::size_t from = static_cast<std::size_t>(row) * columns, to = first_cell(row);
    const auto rho_per_range = static_cast<float>(1 / rays_.row(row).range_per_rho);
    for (std::size_t c = 0; c < columns; ++c) {
      const float range_m = task.range_m[from + c];
      const float left_m = task.tolerance_m[from + c] - range_m * kRounding;
      rho_m_[to + c] = range_m * rho_per_range;
      tolerance_m_[to + c] = range_m > 0 ? left_m * rho_per_range : kAnyTolerance;
      per_rho_m_[to + c] = range_m > 0 ? 1 / rho_m_[to + c] : 1;
    }
    const std::size_t end = row + 1 < tiles_.rows ? first_cell(row + 1) : read;
    for (std::size_t c = to + columns; c < end; ++c) {
      rho_m_[c] = 0;
      tolerance_m_[c] = kAnyTolerance;
      per_rho_m_[c] = 1;
    }
  }
}

int TileSamples::returns(int tile_row, int tile) const {
  int returns = 0;
  for (int row = TileGrid::first_row(tile_row); row < tiles_.end_row(tile_row); ++row) {
    const float* rho_m = &rho_m_[first_cell(row, tile)];
    for (int column = 0; column < kTileColumns; ++column) returns += rho_m[column] > 0 ? 1 : 0;
  }
  return returns;
}

static_assert(SensorRays::kColumnsMore >= kTileColumns, "the last tile may reach beyond the last column");

struct TileSamples::Loops {
  POINTREEL_SIMD_LOOPS static PlaneMoments sum(const TileSamples& samples, int tile_row, int tile) {
    using First = PlaneMomentLanes::First;
    PlaneMomentLanes sums;
    const int first_row = TileGrid::first_row(tile_row);
    add_row<First::yes>(samples, first_row, tile, sums);
    for (int row = first_row + 1; row < samples.tiles_.end_row(tile_row); ++row)
      add_row<First::no>(samples, row, tile, sums);
    return sums.total();
  }

  template <PlaneMomentLanes::First kFirst>
  __attribute__((always_inline)) static void add_row(const TileSamples& samples, int row, int tile,
                                                     PlaneMomentLanes& sums) {
    static_assert(PlaneMomentLanes::kLanes == kTileColumns);
    const SensorRays::Row r = samples.rays_.row(row);
    const float* rhos_m = &samples.rho_m_[samples.first_cell(row, tile)];
    const float* column_cosine = samples.rays_.cos_of_row(row) + tile * kTileColumns;
    const float* column_sine = samples.rays_.sin_of_row(row) + tile * kTileColumns;
    for (std::size_t c = 0; c < kTileColumns; ++c) {
      const double rho_m = rhos_m[c], column_cos = column_cosine[c], column_sin = column_sine[c];
      const double cosine = column_cos * r.cos_alpha - column_sin * r.sin_alpha;
      const double sine = column_sin * r.cos_alpha + column_cos * r.sin_alpha;
      sums.add<kFirst>(c, rho_m * cosine - r.side_offset_m * sine, rho_m * sine + r.side_offset_m * cosine,
                       r.slope * rho_m + r.offset_m, rho_m > 0 ? 1.0 : 0.0);
    }
  }
};

bool TileSamples::bends(int tile_row, int tile) const {
  std::array<RowCells, kTileRows> rows;
  std::size_t count = 0;
  for (int row = TileGrid::first_row(tile_row); row < tiles_.end_row(tile_row); ++row)
    rows[count++] = cells(row);
  return tile_bends(std::span(rows).first(count), static_cast<std::size_t>(tile) * kTileColumns);
}

bool TileSamples::PlaneTest::holds(int first, int end) const {
  for (int tile = first; tile < end; ++tile) {
    if (!holds(tile)) return false;
  }
  return true;
}

const PlaneMoments& TileSamples::moments(int tile_row, int tile) {
  const std::size_t index = tiles_.index(tile_row, tile);
  if (has_moments_[index] == 0) {
    has_moments_[index] = 1;
    moments_[index] = Loops::sum(*this, tile_row, tile);
  }
  return moments_[index];
}

}  // namespace pointreel
