#include "codec/grid_points.h"

#include "sensor/point_order.h"

namespace pointreel {

CodedGeometry merged(const CodingGrid& coding, std::span<const std::uint32_t> cells,
                     std::span<const float> range_of_cell_m, std::span<const std::uint32_t> strays,
                     int threads) {
  CodedGeometry geometry;
  geometry.rows = static_cast<std::uint32_t>(coding.rows());
  geometry.columns = static_cast<std::uint32_t>(coding.columns());
  const std::size_t count = cells.size() + strays.size();
  geometry.cell_of_point.resize(count);
  geometry.range_m.resize(count);
  for (const std::uint32_t stray : strays) {
    geometry.cell_of_point[stray] = -1;
    geometry.range_m[stray] = 0;
  }
  for_each_grid_point(count, strays, threads,
                      [&, image_index = CodingGrid::Finder(coding)](std::size_t i, std::size_t k) mutable {
                        const std::size_t cell = cells[k];
                        geometry.cell_of_point[i] = static_cast<std::int32_t>(image_index(cell));
                        geometry.range_m[i] = range_of_cell_m[cell];
                      });
  return geometry;
}

FiringPlaces firing_places(const SensorModel& model, const SweepGrid& grid,
                           std::span<const std::uint32_t> cells, const CodedGeometry& geometry) {
  FiringPlaces places{{}, std::max(1, static_cast<std::int32_t>(model.row_count()))};
  const auto of_cells = firing_places_of(model, grid, cells);
  places.of_point.reserve(geometry.cell_of_point.size());
  std::size_t next_cell = 0;
  for (const std::int32_t cell : geometry.cell_of_point)
    places.of_point.push_back(cell < 0 ? -1 : of_cells[next_cell++]);
  return places;
}

}  // namespace pointreel
