#include <optional>
#include <string>

#include "base/parallel.h"
#include "codec/corrections.h"
#include "codec/error_budget.h"
#include "codec/grid_points.h"
#include "codec/gridded_geometry.h"
#include "codec/relative_pose.h"
#include "codec/sections.h"
#include "predict/coding_grid.h"
#include "scatter/stray_list.h"
#include "sensor/order_moves.h"
#include "sensor/point_order.h"
#include "sensor/sensor_coding.h"

namespace pointreel {
namespace {

// One position a cell of the sensor grid; those of empty cells mean nothing.
std::vector<Point3f> positions_of_cells(const RayTable& rays, std::span<const float> range_of_cell_m,
                                        int threads) {
  std::vector<Point3f> positions(range_of_cell_m.size());
  const std::size_t columns = rays.column_count();
  parallel_for(rays.row_count(), threads, [&](std::size_t row) {
    rays.positions_of_row(row, range_of_cell_m.subspan(row * columns, columns),
                          std::span(positions).subspan(row * columns, columns));
  });
  return positions;
}

Result<RangeQuantiser> get_quantiser(ByteReader& reader, const SensorModel& model) {
  RangeQuantiser quantiser;
  quantiser.step_m = reader.get<float>();
  const auto on_lattice = reader.get<std::uint8_t>();
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends before its step of range"};
  if (!(quantiser.step_m >= 1e-5F && quantiser.step_m <= 10) || on_lattice > 1 ||
      (on_lattice == 1 && model.range_phase.size() != model.row_count())) {
    return Error{ErrorCode::corrupt, "its step of range is not valid"};
  }
  if (on_lattice == 1) quantiser.lattice_phase_m = lattice_phases_m(model);
  return quantiser;
}

// What comes before planes and ranges.
struct Head {
  SweepGrid grid;
  RangeQuantiser quantiser;
  std::optional<SweepMotion> motion;  // of predicted frames
};

Result<Head> decode_head(const SensorModel& model, bool predicted, ByteReader& reader) {
  auto grid = decode_sweep_grid(model, get_section(reader));
  if (!grid) return grid.error();
  auto quantiser = get_quantiser(reader, model);
  if (!quantiser) return quantiser.error();
  if (grid->column_count() == 0) return Error{ErrorCode::corrupt, "its grid has no columns"};
  Head head{*std::move(grid), *std::move(quantiser), std::nullopt};
  if (predicted) {
    const auto motion = get_sweep_motion(reader);
    if (!motion) return motion.error();
    head.motion = *motion;
  }
  return head;
}

}  // namespace

Result<GriddedPlanes> decode_gridded_planes(const GeometrySetting& setting, const GriddedPlanes* reference,
                                            ByteReader& reader) {
  const auto& [model, max_error_m, effort, threads, plane_stage, warp_memory, beside] = setting;
  auto head = decode_head(model, reference != nullptr, reader);
  if (!head) return head.error();
  const CodingGrid coding(model, head->grid);
  std::optional<EarlierPlanes> earlier;
  if (reference != nullptr)
    earlier.emplace(EarlierPlanes{reference->grid, reference->tiles, head->motion->T_ref_cur});
  auto tiles = decode_planes({model, head->grid, coding, max_error_m, threads, plane_stage},
                             rays_of(model, head->grid, coding), earlier ? &*earlier : nullptr, reader);
  if (!tiles) return tiles.error();
  return GriddedPlanes{std::move(head->grid), *std::move(tiles)};
}

Result<DecodedCells> decode_cells(const GeometrySetting& setting, const CodedImage* reference,
                                  ByteReader& reader, CodedImage& image) {
  const auto& [model, max_error_m, effort, threads, plane_stage, warp_memory, beside] = setting;
  auto head = decode_head(model, reference != nullptr, reader);
  if (!head) return head.error();
  const SweepGrid& grid = head->grid;
  CodingGrid coding(model, grid);
  std::optional<Prediction> prediction;
  if (reference != nullptr)
    prediction.emplace(Prediction{reference->reference, reference->planes, *head->motion});
  PlaneSection planes;
  if (plane_stage != PlaneStage::none) {
    const SensorRays rays = rays_of(model, grid, coding);
    const auto earlier = earlier_planes(prediction);
    auto tiles = decode_planes({model, grid, coding, max_error_m, threads, plane_stage}, rays,
                               earlier ? &*earlier : nullptr, reader);
    if (!tiles) return tiles.error();
    planes.tiles = *std::move(tiles);
    planes.range_m = ranges_on_planes_m(rays, planes.tiles, threads);
  }
  GridImage ranges = coding.empty_image();
  auto states =
      decode_image({model, grid, head->quantiser, effort, threads, warp_memory, planes.range_m, beside},
                   prediction ? &*prediction : nullptr, reader, ranges);
  if (!states) return states.error();
  auto range_of_cell_m = coding.ranges_of_cells(ranges, threads);
  if (reference != nullptr) draw_together(warp_memory.image, head->quantiser.step_m, ranges);
  image = {{grid, std::move(ranges), *std::move(states)}, std::move(planes.tiles)};
  return DecodedCells{std::move(head->grid), std::move(coding), std::move(range_of_cell_m)};
}

Result<DecodedGeometry> decode_points(const PointsSetting& setting, std::size_t points_out,
                                      const DecodedCells& decoded_cells, ByteReader& reader) {
  const auto& [model, max_error_m, threads] = setting;
  const auto& [grid, coding, range_of_cell_m] = decoded_cells;
  auto cells = cells_in_order(occupied_cells(range_of_cell_m), range_of_cell_m, model, grid, threads);
  if (cells.size() > points_out) {
    return Error{ErrorCode::corrupt, "its grid holds " + std::to_string(cells.size()) +
                                         " points, more than its " + std::to_string(points_out)};
  }
  const auto moves = decode_moves(cells.size(), get_section(reader));
  if (!moves) return moves.error();
  if (!moves->empty()) cells = apply_moves(cells, *moves);
  auto positions = positions_of_cells(RayTable(model, grid), range_of_cell_m, threads);
  const auto corrections = decode_corrections(get_section(reader), cells.size());
  if (!corrections) return corrections.error();
  const CorrectionSteps steps(max_error_m);
  for (const Correction& correction : *corrections) {
    Point3f& position = positions[cells[correction.index]];
    position = steps.apply(position, correction);
  }

  const auto stray_bytes = get_section(reader);
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends before its strays"};
  std::vector<Stray> strays;
  if (!stray_bytes.empty()) {
    auto result = decode_strays(stray_bytes, max_error_m, points_out);
    if (!result) return result.error();
    strays = *std::move(result);
  }
  if (cells.size() + strays.size() != points_out) {
    return Error{ErrorCode::corrupt, "it decodes to " + std::to_string(cells.size() + strays.size()) +
                                         " points instead of " + std::to_string(points_out)};
  }

  DecodedGeometry result;
  result.points.cells = std::move(cells);
  result.points.strays.reserve(strays.size());
  for (const Stray& stray : strays) result.points.strays.push_back(stray.index);
  result.order_kept = grid.order.kind != OrderKind::none;
  if (grid.order.in_bursts) {
    auto bursts = decode_bursts(firing_places(model, grid, result.points), get_section(reader));
    if (!bursts) return bursts.error();
    result.bursts = *std::move(bursts);
  }
  result.positions.resize(points_out);
  for_each_grid_point(points_out, result.points.strays, threads, [&](std::size_t i, std::size_t k) {
    result.positions[i] = positions[result.points.cells[k]];
  });
  for (const Stray& stray : strays) result.positions[stray.index] = stray.position;
  return result;
}

}  // namespace pointreel
