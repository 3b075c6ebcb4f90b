#include "planes/tile_samples.h"

namespace pointreel {

TileSamples::TileSamples(const PlaneTask& task)
    : rays_(task.rays), tiles_(task.rays.rows(), task.rays.columns()) {
  constexpr float kAnyM = 1e30F;
  // Of the range: what is left of the tolerance after its rounding to float32, which the test has, too.
  constexpr float kRounding = 5e-7F;
  const std::size_t padded = first_cell(tiles_.rows);
  rho_m_.resize(padded);
  tolerance_m_.resize(padded);
  cos_.resize(padded);
  sin_.resize(padded);
  has_moments_.resize(tiles_.count());
  moments_.resize(tiles_.count());
  const auto columns = static_cast<std::size_t>(tiles_.columns);
  for (int row = 0; row < tiles_.rows; ++row) {
    const std::size_t from = static_cast<std::size_t>(row) * columns, to = first_cell(row);
    const auto rho_per_range = static_cast<float>(1 / rays_.row(row).range_per_rho);
    std::copy_n(rays_.cos_of_row(row), columns, &cos_[to]);
    std::copy_n(rays_.sin_of_row(row), columns, &sin_[to]);
    for (std::size_t c = 0; c < columns; ++c) {
      const float range_m = task.range_m[from + c];
      const float left_m = task.tolerance_m[from + c] - range_m * kRounding;
      rho_m_[to + c] = range_m * rho_per_range;
      tolerance_m_[to + c] = range_m > 0 ? left_m * rho_per_range : kAnyM;
    }
    for (std::size_t c = to + columns; c < first_cell(row + 1); ++c) {
      rho_m_[c] = 0;
      tolerance_m_[c] = kAnyM;
      cos_[c] = sin_[c] = 0;
    }
  }
}

bool TileSamples::has_returns(int tile_row, int tile) const {
  for (int row = TileGrid::first_row(tile_row); row < tiles_.end_row(tile_row); ++row) {
    if ((row_of(rho_m_, first_cell(row) + static_cast<std::size_t>(tile * kTileColumns)) > 0).any())
      return true;
  }
  return false;
}

const PlaneMoments& TileSamples::moments(int tile_row, int tile) {
  using Doubles = Eigen::Array<double, kTileColumns, 1>;
  const std::size_t index = tiles_.index(tile_row, tile);
  PlaneMoments& sums = moments_[index];
  if (has_moments_[index] != 0) return sums;
  has_moments_[index] = 1;
  sums = PlaneMoments();
  for (int row = TileGrid::first_row(tile_row); row < tiles_.end_row(tile_row); ++row) {
    const SensorRays::Row& r = rays_.row(row);
    const std::size_t cell = first_cell(row) + static_cast<std::size_t>(tile * kTileColumns);
    const Doubles rho_m = row_of(rho_m_, cell).cast<double>();
    const Doubles column_cos = row_of(cos_, cell).cast<double>(),
                  column_sin = row_of(sin_, cell).cast<double>();
    const Doubles cosine = column_cos * r.cos_alpha - column_sin * r.sin_alpha;
    const Doubles sine = column_sin * r.cos_alpha + column_cos * r.sin_alpha;
    const Doubles x_m = rho_m * cosine - r.side_offset_m * sine;
    const Doubles y_m = rho_m * sine + r.side_offset_m * cosine;
    const Doubles z_m = r.slope * rho_m + r.offset_m;
    sums.add_points<Doubles>(x_m, y_m, z_m, (rho_m > 0).cast<double>());
  }
  return sums;
}

}  // namespace pointreel
