#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/first_where.h"
#include "base/raw_vector.h"
#include "base/simd_loops.h"
#include "codec/corrections.h"
#include "codec/grid_points.h"
#include "codec/gridded_geometry.h"
#include "codec/relative_pose.h"
#include "codec/sections.h"
#include "codec/verification.h"
#include "scatter/stray_list.h"
#include "sensor/order_moves.h"
#include "sensor/point_order.h"
#include "sensor/sensor_coding.h"

namespace pointreel {
namespace {

// By how much the range of each cell of the sensor grid may be off, given how far its point is off its ray;
// where there is none, anything.
POINTREEL_SIMD_LOOPS RawVector<float> range_tolerances_m(const GriddedSweep& sweep, double max_error_m) {
  const auto squared_m2 = static_cast<float>(max_error_m * max_error_m);
  const std::size_t cells = sweep.point_of_cell.size();
  RawVector<float> tolerances_m(cells);
  float* of_cell_m = tolerances_m.data();
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::uint32_t point = sweep.point_of_cell[cell];
    of_cell_m[cell] = sweep.deviation_m[point == kNoPoint ? 0 : point];
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {  // becomes SIMD code
    const float left_m2 = squared_m2 - of_cell_m[cell] * of_cell_m[cell];
    of_cell_m[cell] = std::sqrt(left_m2 > 0 ? left_m2 : 0.0F);
  }
  return tolerances_m;
}

void put_quantiser(ByteWriter& writer, const RangeQuantiser& quantiser) {
  writer.put(quantiser.step_m);
  writer.put(static_cast<std::uint8_t>(quantiser.on_lattice() ? 1 : 0));
}

}  // namespace

EncodedCells encode_cells(const GeometrySetting& setting, const GriddedSweep& sweep, SweepCells& cells,
                          const Prediction* prediction, FrameStatistics& statistics) {
  const auto& [model, max_error_m, effort, threads, plane_stage, warp_memory, beside] = setting;
  auto& [quantiser, coding, image] = cells;
  ByteWriter writer;
  std::optional<Prediction> rounded;
  if (prediction != nullptr) {
    put_sweep_motion(writer, prediction->motion);
    statistics.grid_bits += bits_of(writer.size());
    rounded.emplace(Prediction{prediction->reference, prediction->planes, *quantised(prediction->motion)});
  }
  PlaneSection planes;
  if (plane_stage != PlaneStage::none) {
    const auto earlier = earlier_planes(rounded);
    const GridImage tolerance = coding.image_of(range_tolerances_m(sweep, max_error_m), threads);
    planes = encode_planes({model, sweep.grid, coding, max_error_m, threads, plane_stage},
                           earlier ? &*earlier : nullptr, image, tolerance, writer, statistics);
  }
  auto states =
      encode_image({model, sweep.grid, quantiser, effort, threads, warp_memory, planes.range_m, beside},
                   rounded ? &*rounded : nullptr, image, writer, statistics);
  EncodedCells encoded;
  encoded.bytes = writer.take();
  encoded.range_of_cell_m = coding.ranges_of_cells(image, threads);
  if (prediction != nullptr) draw_together(warp_memory.image, quantiser.step_m, image);
  encoded.image = {{sweep.grid, std::move(image), std::move(states)}, std::move(planes.tiles)};
  return encoded;
}

EncodedPoints encode_points(const PointsSetting& setting, const PointCloud& cloud, GriddedSweep sweep,
                            const SweepCells& sweep_cells, const EncodedCells& encoded_cells,
                            std::span<const std::uint32_t> bursts, ByteWriter& writer,
                            FrameStatistics& statistics) {
  const auto& [model, max_error_m, threads] = setting;
  const std::span<const float> range_of_cell_m = encoded_cells.range_of_cell_m;
  // The points as the decoder will have them, in its sequence.
  const auto occupied = occupied_cells(range_of_cell_m);
  auto cells = cells_of_points(sweep);
  const auto moves = encode_moves(settle_order(model, occupied, range_of_cell_m, cells, sweep, threads));
  const bool order_kept = sweep.grid.order.kind != OrderKind::none;
  if (!order_kept) cells = cells_in_order(occupied, range_of_cell_m, model, sweep.grid, threads);
  sweep.grid.order.in_bursts = !bursts.empty() && order_kept;

  const auto grid_bytes = encode_sweep_grid(model, sweep.grid);
  put_section(writer, grid_bytes);
  put_quantiser(writer, sweep_cells.quantiser);
  writer.put(encoded_cells.bytes);

  const auto corrections =
      find_corrections(model, cloud, sweep, range_of_cell_m, cells, max_error_m, threads);

  EncodedPoints encoded;
  std::vector<Stray> strays;
  if (!order_kept) {
    for (const std::uint32_t cell : cells) encoded.output_order.push_back(sweep.point_of_cell[cell]);
  }
  const std::int32_t* cell_of_point = sweep.cell_of_point.data();
  for_each_where(
      cloud.size(), [=](std::size_t i) { return static_cast<int>(cell_of_point[i] < 0); },
      [&](std::size_t i) {
        const auto index = static_cast<std::uint32_t>(order_kept ? i : encoded.output_order.size());
        if (!order_kept) encoded.output_order.push_back(static_cast<std::uint32_t>(i));
        strays.push_back({index, cloud.positions[i]});
        encoded.points.strays.push_back(index);
      });
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
  encoded.points.cells = std::move(cells);
  if (sweep.grid.order.in_bursts) {
    const auto burst_bytes = encode_bursts(bursts, firing_places(model, sweep.grid, encoded.points));
    put_section(writer, burst_bytes);
    statistics.order_bits += bits_of(burst_bytes.size());
  }
  return encoded;
}

}  // namespace pointreel
