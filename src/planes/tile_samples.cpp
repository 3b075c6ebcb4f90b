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
  moments_.resize(tiles_.count());
  returns_.resize(tiles_.count());
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
    std::fill(&tolerance_m_[to] + columns, &tolerance_m_[0] + first_cell(row + 1), kAnyM);
    sum_moments(row);
  }
}

void TileSamples::sum_moments(int row) {
  using Doubles = Eigen::Array<double, kTileColumns, 1>;
  const SensorRays::Row& r = rays_.row(row);
  const std::size_t first_tile = tiles_.index(row / kTileRows, 0);
  std::size_t cell = first_cell(row);
  for (std::size_t tile = first_tile; tile < first_tile + static_cast<std::size_t>(tiles_.across); ++tile) {
    const Row hits = (row_of(rho_m_, cell) > 0).cast<float>();
    const auto count = static_cast<int>(hits.sum());
    if (count > 0) {
      const Doubles rho_m = row_of(rho_m_, cell).cast<double>();
      const Doubles column_cos = row_of(cos_, cell).cast<double>(),
                    column_sin = row_of(sin_, cell).cast<double>();
      const Doubles cosine = column_cos * r.cos_alpha - column_sin * r.sin_alpha;
      const Doubles sine = column_sin * r.cos_alpha + column_cos * r.sin_alpha;
      const Doubles x_m = rho_m * cosine - r.side_offset_m * sine;
      const Doubles y_m = rho_m * sine + r.side_offset_m * cosine;
      const Doubles z_m = r.slope * rho_m + r.offset_m;
      moments_[tile].add_points<Doubles>(x_m, y_m, z_m, hits.cast<double>());
      returns_[tile] = static_cast<std::uint8_t>(returns_[tile] + count);
    }
    cell += kTileColumns;
  }
}

}  // namespace pointreel
