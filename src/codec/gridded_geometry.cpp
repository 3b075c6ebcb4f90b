#include "codec/gridded_geometry.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include "base/parallel.h"
#include "codec/corrections.h"
#include "codec/error_budget.h"
#include "codec/relative_pose.h"
#include "codec/sections.h"
#include "codec/verification.h"
#include "predict/coding_grid.h"
#include "scatter/stray_list.h"
#include "sensor/burst_sort.h"
#include "sensor/order_moves.h"
#include "sensor/point_order.h"
#include "sensor/sensor_coding.h"

namespace pointreel {
namespace {

// Those of its points from one on, one after the other.
const float* coordinates_of(const PointCloud& cloud, std::size_t first) {
  static_assert(sizeof(Point3f) == 3 * sizeof(float));
  return &cloud.positions[first].x;
}

// Points that float32 ranges and positions cannot hold within the bound leave the grid.
void drop_unreachable(const PointCloud& cloud, double max_error_m, GriddedSweep& sweep) {
  const auto reach_m = static_cast<float>(std::min(CorrectionSteps(max_error_m).reach_m(),
                                                   max_error_m * static_cast<double>(kMostRangeSteps) / 16));
  constexpr float kNearestM = 0.01F;
  // Hardly a block has one.
  constexpr std::size_t kBlock = 64;
  for (std::size_t first = 0; first < cloud.size(); first += kBlock) {
    const std::size_t count = std::min(cloud.size() - first, kBlock);
    const float* coordinates_m = coordinates_of(cloud, first);
    const float* ranges_m = &sweep.range_m[first];
    int any = 0;
    for (std::size_t k = 0; k < 3 * count; ++k) any |= std::fabs(coordinates_m[k]) < reach_m ? 0 : 1;
    for (std::size_t i = 0; i < count; ++i)
      any |= (ranges_m[i] < reach_m ? 0 : 1) | (ranges_m[i] > kNearestM ? 0 : 1);
    if (any == 0) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const float* p = coordinates_m + 3 * i;
      const float farthest_m = std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2]), ranges_m[i]});
      if (!(farthest_m < reach_m && ranges_m[i] > kNearestM)) sweep.cell_of_point[first + i] = -1;
    }
  }
}

// By how much the range of each cell of the sensor grid may be off, given how far its point is off its ray.
std::vector<float> range_tolerances_m(const GriddedSweep& sweep, std::size_t cells, double max_error_m) {
  std::vector<float> tolerance_m(cells);
  const auto squared_m2 = static_cast<float>(max_error_m * max_error_m);
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    const float deviation_m = sweep.deviation_m[i];
    tolerance_m[static_cast<std::size_t>(sweep.cell_of_point[i])] =
        std::sqrt(std::max(0.0F, squared_m2 - deviation_m * deviation_m));
  }
  return tolerance_m;
}

std::vector<std::uint8_t> occupied_cells(std::span<const float> range_of_cell_m) {
  std::vector<std::uint8_t> occupied(range_of_cell_m.size());
  for (std::size_t cell = 0; cell < occupied.size(); ++cell)
    occupied[cell] = range_of_cell_m[cell] > 0 ? 1 : 0;
  return occupied;
}

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
  geometry.cell_of_point.assign(count, -1);
  geometry.range_m.assign(count, 0);
  CodingGrid::Finder image_index(coding);
  std::size_t i = 0, next_cell = 0;
  const auto take_until = [&](std::size_t end) {
    for (; i < end; ++i, ++next_cell) {
      const std::size_t cell = cells[next_cell];
      geometry.cell_of_point[i] = static_cast<std::int32_t>(image_index(cell));
      geometry.range_m[i] = range_of_cell_m[cell];
    }
  };
  for (const std::uint32_t stray : stray_indices) {
    take_until(stray);
    ++i;
  }
  take_until(count);
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

// What comes before planes and ranges.
struct Head {
  SweepGrid grid;
  RangeQuantiser quantiser;
  std::optional<Pose> T_ref_cur;  // of predicted frames
};

Result<Head> decode_head(const SensorModel& model, bool predicted, ByteReader& reader) {
  auto grid = decode_sweep_grid(model, get_section(reader));
  if (!grid) return grid.error();
  auto quantiser = get_quantiser(reader, model);
  if (!quantiser) return quantiser.error();
  if (grid->column_count() == 0) return Error{ErrorCode::corrupt, "its grid has no columns"};
  Head head{*std::move(grid), *std::move(quantiser), std::nullopt};
  if (predicted) {
    const auto T_ref_cur = get_relative_pose(reader);
    if (!T_ref_cur) return T_ref_cur.error();
    head.T_ref_cur = *T_ref_cur;
  }
  return head;
}

std::optional<EarlierPlanes> earlier_planes(const std::optional<Prediction>& prediction) {
  if (!prediction) return std::nullopt;
  return EarlierPlanes{prediction->reference.grid, prediction->planes, prediction->T_ref_cur};
}

}  // namespace

Result<GriddedPlanes> decode_gridded_planes(const GeometrySetting& setting, const GriddedPlanes* reference,
                                            ByteReader& reader) {
  const auto& [model, max_error_m, effort, threads, plane_stage, warp_memory] = setting;
  auto head = decode_head(model, reference != nullptr, reader);
  if (!head) return head.error();
  const CodingGrid coding(model, head->grid);
  std::optional<EarlierPlanes> earlier;
  if (reference != nullptr)
    earlier.emplace(EarlierPlanes{reference->grid, reference->tiles, *head->T_ref_cur});
  auto tiles = decode_planes({model, head->grid, coding, max_error_m, threads, plane_stage},
                             rays_of(model, head->grid, coding), earlier ? &*earlier : nullptr, reader);
  if (!tiles) return tiles.error();
  return GriddedPlanes{std::move(head->grid), *std::move(tiles)};
}

GeometrySetting geometry_setting(const StreamHeader& header, const SensorModel& model, int threads,
                                 WarpMemory& warp_memory) {
  const PlaneStage planes = header.method != Method::planes ? PlaneStage::none
                            : header.effort == Effort::fast ? PlaneStage::wherever_it_fits
                                                            : PlaneStage::where_it_pays;
  return {model, header.max_error_m, header.effort, threads, planes, warp_memory};
}

EncodedGeometry encode_gridded(const GeometrySetting& setting, const PointCloud& cloud, GriddedSweep sweep,
                               std::span<const std::uint32_t> bursts, const Prediction* prediction,
                               ByteWriter& writer, FrameStatistics& statistics) {
  const auto& [model, max_error_m, effort, threads, plane_stage, warp_memory] = setting;
  drop_unreachable(cloud, max_error_m, sweep);
  const RangeQuantiser quantiser = choose_quantiser(model, sweep, max_error_m);

  // Predict and code.
  const CodingGrid coding(model, sweep.grid);
  std::vector<float> range_of_cell_m(coding.rows() * coding.columns());
  const auto point_of_cell = std::make_unique_for_overwrite<std::uint32_t[]>(range_of_cell_m.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    const auto cell = static_cast<std::size_t>(sweep.cell_of_point[i]);
    point_of_cell[cell] = static_cast<std::uint32_t>(i);
    range_of_cell_m[cell] = sweep.range_m[i];
  }
  GridImage image = coding.image_of(range_of_cell_m, threads);
  ByteWriter image_bytes;
  std::optional<Prediction> rounded;
  if (prediction != nullptr) {
    put_relative_pose(image_bytes, prediction->T_ref_cur);
    statistics.grid_bits += bits_of(image_bytes.size());
    rounded.emplace(Prediction{prediction->reference, prediction->planes, *quantised(prediction->T_ref_cur)});
  }
  PlaneSection planes;
  if (plane_stage != PlaneStage::none) {
    const auto earlier = earlier_planes(rounded);
    const GridImage tolerance =
        coding.image_of(range_tolerances_m(sweep, range_of_cell_m.size(), max_error_m), threads);
    planes = encode_planes({model, sweep.grid, coding, max_error_m, threads, plane_stage},
                           earlier ? &*earlier : nullptr, image, tolerance, image_bytes, statistics);
  }
  auto states = encode_image({model, sweep.grid, quantiser, effort, threads, warp_memory, planes.range_m},
                             rounded ? &*rounded : nullptr, image, image_bytes, statistics);

  // The points as the decoder will have them, in its sequence.
  range_of_cell_m = coding.ranges_of_cells(image, threads);
  const auto occupied = occupied_cells(range_of_cell_m);
  auto cells = cells_of_points(sweep);
  const auto moves = encode_moves(settle_order(model, occupied, range_of_cell_m, cells, sweep, threads));
  const bool order_kept = sweep.grid.order.kind != OrderKind::none;
  if (!order_kept) cells = cells_in_order(occupied, range_of_cell_m, model, sweep.grid, threads);
  sweep.grid.order.in_bursts = !bursts.empty() && order_kept;

  const auto grid_bytes = encode_sweep_grid(model, sweep.grid);
  put_section(writer, grid_bytes);
  put_quantiser(writer, quantiser);
  writer.put(image_bytes.bytes());

  const auto corrections =
      find_corrections(RayTable(model, sweep.grid), cloud, range_of_cell_m,
                       {point_of_cell.get(), range_of_cell_m.size()}, cells, max_error_m, threads);

  EncodedGeometry encoded;
  std::vector<Stray> strays;
  std::vector<std::uint32_t> stray_indices;
  if (order_kept) {
    encoded.output_order.resize(cloud.size());
    std::iota(encoded.output_order.begin(), encoded.output_order.end(), 0u);
  } else {
    for (const std::uint32_t cell : cells) encoded.output_order.push_back(point_of_cell[cell]);
  }
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
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
  encoded.geometry = merged(coding, cells, range_of_cell_m, stray_indices);
  encoded.geometry.order_kept = order_kept;
  if (sweep.grid.order.in_bursts) {
    const auto burst_bytes = encode_bursts(bursts, firing_places(model, sweep.grid, cells, encoded.geometry));
    put_section(writer, burst_bytes);
    statistics.order_bits += bits_of(burst_bytes.size());
    encoded.geometry.bursts.assign(bursts.begin(), bursts.end());
  }
  if (prediction != nullptr) draw_together(warp_memory.image, quantiser.step_m, image);
  encoded.image = {{std::move(sweep.grid), std::move(image), std::move(states)}, std::move(planes.tiles)};
  return encoded;
}

Result<DecodedGeometry> decode_gridded(const GeometrySetting& setting, std::size_t points_out,
                                       const CodedImage* reference, ByteReader& reader) {
  const auto& [model, max_error_m, effort, threads, plane_stage, warp_memory] = setting;
  const auto head = decode_head(model, reference != nullptr, reader);
  if (!head) return head.error();
  const SweepGrid* grid = &head->grid;
  const CodingGrid coding(model, *grid);
  std::optional<Prediction> prediction;
  if (reference != nullptr)
    prediction.emplace(Prediction{reference->reference, reference->planes, *head->T_ref_cur});
  PlaneSection planes;
  if (plane_stage != PlaneStage::none) {
    const SensorRays rays = rays_of(model, *grid, coding);
    const auto earlier = earlier_planes(prediction);
    auto tiles = decode_planes({model, *grid, coding, max_error_m, threads, plane_stage}, rays,
                               earlier ? &*earlier : nullptr, reader);
    if (!tiles) return tiles.error();
    planes.tiles = *std::move(tiles);
    planes.range_m = ranges_on_planes_m(rays, planes.tiles, threads);
  }
  GridImage image = coding.empty_image();
  auto states = decode_image({model, *grid, head->quantiser, effort, threads, warp_memory, planes.range_m},
                             prediction ? &*prediction : nullptr, reader, image);
  if (!states) return states.error();

  const auto range_of_cell_m = coding.ranges_of_cells(image, threads);
  auto cells = cells_in_order(occupied_cells(range_of_cell_m), range_of_cell_m, model, *grid, threads);
  if (cells.size() > points_out) {
    return Error{ErrorCode::corrupt, "its grid holds " + std::to_string(cells.size()) +
                                         " points, more than its " + std::to_string(points_out)};
  }
  const auto moves = decode_moves(cells.size(), get_section(reader));
  if (!moves) return moves.error();
  if (!moves->empty()) cells = apply_moves(cells, *moves);
  auto positions = positions_of_cells(RayTable(model, *grid), range_of_cell_m, threads);
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
  stray_indices.reserve(strays.size());
  for (const Stray& stray : strays) stray_indices.push_back(stray.index);
  result.geometry = merged(coding, cells, range_of_cell_m, stray_indices);
  result.geometry.order_kept = grid->order.kind != OrderKind::none;
  if (grid->order.in_bursts) {
    auto bursts = decode_bursts(firing_places(model, *grid, cells, result.geometry), get_section(reader));
    if (!bursts) return bursts.error();
    result.geometry.bursts = *std::move(bursts);
  }
  result.positions.resize(points_out);
  std::size_t next_cell = 0, next_stray = 0;
  for (std::size_t i = 0; i < points_out; ++i) {
    const bool stray = result.geometry.cell_of_point[i] < 0;
    result.positions[i] = stray ? strays[next_stray++].position : positions[cells[next_cell++]];
  }
  if (reference != nullptr) draw_together(warp_memory.image, head->quantiser.step_m, image);
  result.image = {{*grid, std::move(image), *std::move(states)}, std::move(planes.tiles)};
  return result;
}

}  // namespace pointreel
