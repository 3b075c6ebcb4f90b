#include "codec/gridded_geometry.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/parallel.h"
#include "predict/coding_grid.h"
#include "codec/corrections.h"
#include "codec/error_budget.h"
#include "codec/sections.h"
#include "scatter/stray_list.h"
#include "sensor/burst_sort.h"
#include "sensor/order_moves.h"
#include "sensor/point_order.h"
#include "sensor/sensor_coding.h"

namespace pointreel {
namespace {

// Points that float32 ranges and positions cannot hold within the bound leave the grid.
void drop_unreachable(const PointCloud& cloud, double max_error_m, GriddedSweep& sweep) {
  const auto reach_m = static_cast<float>(std::min(CorrectionSteps(max_error_m).reach_m(),
                                                   max_error_m * static_cast<double>(kMostRangeSteps) / 16));
  constexpr float kNearestM = 0.01F;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3f& p = cloud.positions[i];
    const float largest_m = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    if (!(largest_m < reach_m) || !(sweep.range_m[i] > kNearestM) || !(sweep.range_m[i] < reach_m)) {
      sweep.cell_of_point[i] = -1;
    }
  }
}

// The parts of the grid's geometry that follow from the decoded image alone.
struct DecodedCells {
  std::vector<std::uint8_t> occupied;  // per cell of the sensor grid
  std::vector<float> range_m;          // the same

  DecodedCells(const CodingGrid& coding, const GridImage& image, int threads)
      : occupied(image.range_m.size()), range_m(image.range_m.size()) {
    parallel_for(coding.rows(), threads, [&](std::size_t row) {
      for (std::size_t column = 0; column < coding.columns(); ++column) {
        const std::size_t cell = row * coding.columns() + column;
        range_m[cell] = image.range_m[coding.image_index(row, column)];
        occupied[cell] = range_m[cell] > 0 ? 1 : 0;
      }
    });
  }
};

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

// Grid points and strays in output order; strays say where they stand.
CodedGeometry merged(const CodingGrid& coding, std::span<const std::uint32_t> cells,
                     std::span<const float> range_of_cell_m, std::span<const std::uint32_t> stray_indices) {
  CodedGeometry geometry;
  geometry.rows = static_cast<std::uint32_t>(coding.rows());
  geometry.columns = static_cast<std::uint32_t>(coding.columns());
  const std::size_t count = cells.size() + stray_indices.size();
  geometry.cell_of_point.reserve(count);
  geometry.range_m.reserve(count);
  std::size_t next_cell = 0, next_stray = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (next_stray < stray_indices.size() && stray_indices[next_stray] == i) {
      ++next_stray;
      geometry.cell_of_point.push_back(-1);
      geometry.range_m.push_back(0);
    } else {
      const std::size_t cell = cells[next_cell++];
      geometry.cell_of_point.push_back(static_cast<std::int32_t>(coding.image_index(cell)));
      geometry.range_m.push_back(range_of_cell_m[cell]);
    }
  }
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

void put_quantiser(ByteWriter& writer, const RangeQuantiser& quantiser) {
  writer.put(quantiser.step_m);
  writer.put(static_cast<std::uint8_t>(quantiser.on_lattice() ? 1 : 0));
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

}  // namespace

EncodedGeometry encode_gridded(const GeometrySetting& setting, const PointCloud& cloud, GriddedSweep sweep,
                               std::span<const std::uint32_t> bursts, const Prediction* prediction,
                               ByteWriter& writer, FrameStatistics& statistics) {
  const auto& [model, max_error_m, effort, threads] = setting;
  drop_unreachable(cloud, max_error_m, sweep);
  sweep.grid.order.in_bursts = !bursts.empty() && sweep.grid.order.kind != OrderKind::none;
  const auto grid_bytes = encode_sweep_grid(model, sweep.grid);
  put_section(writer, grid_bytes);
  const RangeQuantiser quantiser = choose_quantiser(model, sweep, max_error_m);
  put_quantiser(writer, quantiser);

  // Predict and code.
  const CodingGrid coding(model, sweep.grid);
  GridImage image = coding.empty_image();
  std::vector<std::uint32_t> point_of_cell(image.range_m.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    const auto cell = static_cast<std::size_t>(sweep.cell_of_point[i]);
    point_of_cell[cell] = static_cast<std::uint32_t>(i);
    image.range_m[coding.image_index(cell)] = sweep.range_m[i];
  }
  encode_image({model, sweep.grid, quantiser, effort, threads}, prediction, image, writer, statistics);

  // The points as the decoder will have them, in its sequence.
  const DecodedCells decoded(coding, image, threads);
  auto cells = cells_in_order(decoded.occupied, decoded.range_m, model, sweep.grid);
  const bool order_kept = sweep.grid.order.kind != OrderKind::none;
  std::vector<std::uint8_t> moves;
  if (order_kept) {
    auto actual = cells_of_points(sweep);
    moves = encode_moves(find_moves(cells, actual, decoded.occupied.size()));
    cells = std::move(actual);
  }
  const auto positions = positions_of_cells(RayTable(model, sweep.grid), decoded.range_m, threads);

  // Verify each, in space and in float32.
  const CorrectionSteps steps(max_error_m);
  std::vector<Correction> corrections;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Point3f& original = cloud.positions[point_of_cell[cells[i]]];
    const Point3f& decoded_position = positions[cells[i]];
    if (distance_m(decoded_position, original) > max_error_m) {
      corrections.push_back(steps.between(static_cast<std::uint32_t>(i), decoded_position, original));
    }
  }

  EncodedGeometry encoded;
  std::vector<Stray> strays;
  std::vector<std::uint32_t> stray_indices;
  if (!order_kept) {
    for (const std::uint32_t cell : cells) encoded.output_order.push_back(point_of_cell[cell]);
  }
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (order_kept) encoded.output_order.push_back(i);
    if (sweep.cell_of_point[i] >= 0) continue;
    const auto index = order_kept ? i : static_cast<std::uint32_t>(encoded.output_order.size());
    if (!order_kept) encoded.output_order.push_back(i);
    strays.push_back({index, cloud.positions[i]});
    stray_indices.push_back(index);
  }
  const auto correction_bytes = encode_corrections(corrections);
  const auto stray_bytes = strays.empty() ? std::vector<std::uint8_t>{} : encode_strays(strays, max_error_m);
  put_section(writer, moves);
  put_section(writer, correction_bytes);
  put_section(writer, stray_bytes);

  statistics.grid_bits += bits_of(grid_bytes.size());
  statistics.order_bits += bits_of(moves.size());
  statistics.correction_bits += bits_of(correction_bytes.size());
  statistics.stray_bits += bits_of(stray_bytes.size());
  statistics.corrected_points += static_cast<std::uint32_t>(corrections.size());
  statistics.stray_points += static_cast<std::uint32_t>(strays.size());
  encoded.geometry = merged(coding, cells, decoded.range_m, stray_indices);
  encoded.geometry.order_kept = order_kept;
  if (sweep.grid.order.in_bursts) {
    const auto burst_bytes = encode_bursts(bursts, firing_places(model, sweep.grid, cells, encoded.geometry));
    put_section(writer, burst_bytes);
    statistics.order_bits += bits_of(burst_bytes.size());
    encoded.geometry.bursts.assign(bursts.begin(), bursts.end());
  }
  encoded.image = {std::move(sweep.grid), std::move(image)};
  return encoded;
}

Result<DecodedGeometry> decode_gridded(const GeometrySetting& setting, std::size_t points_out,
                                       const ReferenceSweep* reference, ByteReader& reader) {
  const auto& [model, max_error_m, effort, threads] = setting;
  const auto grid = decode_sweep_grid(model, get_section(reader));
  if (!grid) return grid.error();
  const auto quantiser = get_quantiser(reader, model);
  if (!quantiser) return quantiser.error();

  if (grid->column_count() == 0) return Error{ErrorCode::corrupt, "its grid has no columns"};
  const CodingGrid coding(model, *grid);
  GridImage image = coding.empty_image();
  const auto decoded_image = decode_image({model, *grid, *quantiser, effort, threads}, reference, reader, image);
  if (!decoded_image) return decoded_image.error();

  const DecodedCells decoded(coding, image, threads);
  auto cells = cells_in_order(decoded.occupied, decoded.range_m, model, *grid);
  if (cells.size() > points_out) {
    return Error{ErrorCode::corrupt, "its grid holds " + std::to_string(cells.size()) +
                                         " points, more than its " + std::to_string(points_out)};
  }
  const auto moves = decode_moves(cells.size(), get_section(reader));
  if (!moves) return moves.error();
  if (!moves->empty()) cells = apply_moves(cells, *moves);
  auto positions = positions_of_cells(RayTable(model, *grid), decoded.range_m, threads);
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
  std::vector<std::uint32_t> stray_indices;
  for (const Stray& stray : strays) stray_indices.push_back(stray.index);
  result.geometry = merged(coding, cells, decoded.range_m, stray_indices);
  result.geometry.order_kept = grid->order.kind != OrderKind::none;
  if (grid->order.in_bursts) {
    auto bursts = decode_bursts(firing_places(model, *grid, cells, result.geometry), get_section(reader));
    if (!bursts) return bursts.error();
    result.geometry.bursts = *std::move(bursts);
  }
  result.positions.reserve(points_out);
  std::size_t next_cell = 0, next_stray = 0;
  for (std::size_t i = 0; i < points_out; ++i) {
    const bool stray = result.geometry.cell_of_point[i] < 0;
    result.positions.push_back(stray ? strays[next_stray++].position : positions[cells[next_cell++]]);
  }
  result.image = {*grid, std::move(image)};
  return result;
}

}  // namespace pointreel
