#include "codec/grid_points.h"

#include "sensor/point_order.h"

namespace pointreel {

PointCells point_cells(const CodingGrid& coding, const OrderedPoints& points,
                       std::span<const float> range_of_cell_m, int threads) {
  const std::size_t count = points.cells.size() + points.strays.size();
  PointCells of;
  of.rows = static_cast<std::uint32_t>(coding.rows());
  of.columns = static_cast<std::uint32_t>(coding.columns());
  of.cell_of_point.resize(count);
  of.range_m.resize(count);
  for (const std::uint32_t stray : points.strays) {
    of.cell_of_point[stray] = -1;
    of.range_m[stray] = 0;
  }
  for_each_grid_point(count, points.strays, threads,
                      [&, image_index = CodingGrid::Finder(coding)](std::size_t i, std::size_t k) mutable {
                        const std::size_t cell = points.cells[k];
                        of.cell_of_point[i] = static_cast<std::int32_t>(image_index(cell));
                        of.range_m[i] = range_of_cell_m[cell];
                      });
  return of;
}

PointCells points_without_cells(std::size_t count) {
  return {0, 0, RawVector<std::int32_t>(count, -1), RawVector<float>(count, 0)};
}

FiringPlaces firing_places(const SensorModel& model, const SweepGrid& grid, const OrderedPoints& points) {
  FiringPlaces places{{}, std::max(1, static_cast<std::int32_t>(model.row_count()))};
  const auto of_cells = firing_places_of(model, grid, points.cells);
  places.of_point.assign(points.cells.size() + points.strays.size(), -1);
  for_each_grid_point(places.of_point.size(), points.strays, 1,
                      [&](std::size_t i, std::size_t k) { places.of_point[i] = of_cells[k]; });
  return places;
}

}  // namespace pointreel
