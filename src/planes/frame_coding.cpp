#include "planes/frame_coding.h"

#include <algorithm>
#include <string>

#include "base/bytes.h"
#include "base/parallel.h"
#include "planes/occupancy_coding.h"
#include "planes/projection.h"
#include "planes/residual_coding.h"
#include "planes/temporal.h"

namespace pointreel {
namespace {

// Anchor ranges in steps of 0.7 thresholds: finer steps cost more bits than the longer runs save, coarser
// ones break too many runs (0.3, 0.5, 0.7 and 1.0 were tried).
constexpr double kPlaneStepPerThreshold = 0.7;

// A cell's occupancy costs at least log2(65536 / 65465) = 0.0016 bits: 5,100 cells a byte. Checked before
// anything is allocated, so that a file of tiny packets cannot keep a decoder busy with huge empty images.
constexpr std::size_t kMaxCellsPerByte = 1 << 13;
constexpr std::size_t kLeftOutBytes = 64;  // trailing zeros, at most

// Temporal, then spatial pass over one row of tiles; runs from left to right.
std::vector<PlaneRun> find_runs(const AngularGrid& grid, const RangeImage& image, const TileLayout& layout,
                                int tile_row, const PlaneTolerance& tolerance, const KeyFrame* key) {
  std::vector<std::int32_t> marks(static_cast<std::size_t>(layout.tile_columns));
  for (int tile = 0; tile < layout.tile_columns; ++tile) {
    marks[tile] = tile_occupied(image, layout, tile_row, tile) ? kUnfitTile : kEmptyTile;
  }
  std::vector<PlaneRun> runs;
  if (const std::int32_t* marks_of_key = key != nullptr ? key->runs_of_tile_row(image, tile_row) : nullptr) {
    encode_tile_row_temporally(grid, image, layout, tile_row, marks.data(), tolerance, key->planes.runs,
                               marks_of_key, runs);
    for (const PlaneRun& run : runs)
      std::fill(marks.begin() + run.first_tile, marks.begin() + run.end_tile, 0);
  }
  encode_tile_row_spatially(grid, image, layout, tile_row, marks.data(), tolerance, runs);
  std::sort(runs.begin(), runs.end(),
            [](const PlaneRun& a, const PlaneRun& b) { return a.first_tile < b.first_tile; });
  return runs;
}

// The runs of all rows of tiles as one map, in raster order.
PlaneMap map_of(const TileLayout& layout, const std::vector<std::vector<PlaneRun>>& runs_by_row) {
  PlaneMap map;
  map.layout = layout;
  map.run_of_tile.assign(layout.count(), kUnfitTile);
  for (const auto& runs : runs_by_row) {
    for (const PlaneRun& run : runs) {
      const auto row_begin =
          map.run_of_tile.begin() + static_cast<std::ptrdiff_t>(layout.index(run.tile_row, 0));
      std::fill(row_begin + run.first_tile, row_begin + run.end_tile,
                static_cast<std::int32_t>(map.runs.size()));
      map.runs.push_back(run);
    }
  }
  return map;
}

// Ranges of all plane cells; the others stay 0. Returns false when a plane is behind one of its cells.
bool render_planes(const AngularGrid& grid, const RangeImage& occupancy, const PlaneMap& map,
                   RangeImage& decoded) {
  decoded = occupancy;
  std::fill(decoded.range_m.begin(), decoded.range_m.end(), 0.0f);
  for (const PlaneRun& run : map.runs) {
    const bool met = all_cells(
        occupancy, map.layout, run.tile_row, run.first_tile, run.end_tile, [&](int row, int column, float) {
          const float range_m = plane_range(grid, run.plane, occupancy.first_row + row, column);
          decoded.at(row, column) = range_m;
          return range_m > 0 && range_m <= 2 * static_cast<float>(kFarthestPoint_m);
        });
    if (!met) return false;
  }
  return true;
}

FrameStatistics count_cells(const RangeImage& image, const PlaneMap& map) {
  FrameStatistics counts;
  counts.runs = static_cast<std::uint32_t>(map.runs.size());
  std::uint32_t occupied = 0;
  for (const float range_m : image.range_m) occupied += range_m > 0;
  for (const PlaneRun& run : map.runs) {
    auto& count = run.kind == RunKind::spatial ? counts.spatial_cells : counts.temporal_cells;
    all_cells(image, map.layout, run.tile_row, run.first_tile, run.end_tile,
              [&](int, int, float) { return ++count; });
  }
  counts.unfit_cells = occupied - counts.spatial_cells - counts.temporal_cells;
  return counts;
}

}  // namespace

FrameSettings frame_settings(const PlanesOptions& options) {
  FrameSettings settings;
  settings.tile_size = options.tile_size;
  settings.tolerance.threshold_m = static_cast<float>(options.threshold_m);
  settings.tolerance.plane_step_m = options.threshold_m * kPlaneStepPerThreshold;
  settings.residual_step_m = options.residual_mode == ResidualMode::raw_float ? 0 : options.residual_step_m;
  return settings;
}

CodedFrame encode_frame(const AngularGrid& grid, const RangeImage& image, const FrameSettings& settings,
                        const KeyFrame* key, int threads) {
  const RangeImage* key_image = key != nullptr ? &key->image : nullptr;
  const TileLayout layout(image, settings.tile_size);

  // The mask does not need the planes nor they its code: it is one more task beside the rows of tiles.
  BitEncoder occupancy_coder;
  std::vector<std::vector<PlaneRun>> runs_by_row(static_cast<std::size_t>(layout.tile_rows));
  parallel_for(1 + runs_by_row.size(), threads, [&](std::size_t task) {
    if (task == 0) {
      RangeImage occupancy = image;
      code_occupancy(occupancy_coder, occupancy, key_image);
    } else {
      runs_by_row[task - 1] =
          find_runs(grid, image, layout, static_cast<int>(task - 1), settings.tolerance, key);
    }
  });

  CodedFrame frame;
  KeyFrame& decoded = frame.decoded;
  decoded.planes = map_of(layout, runs_by_row);
  BitEncoder coder;
  RunCoder<BitEncoder>(coder, grid, settings.tolerance.plane_step_m, key).code(image, decoded.planes);
  const std::size_t plane_bytes = coder.size();
  render_planes(grid, image, decoded.planes, decoded.image);
  ResidualCoder<BitEncoder>(coder, settings.residual_step_m, key_image).code(image, decoded.image);

  const std::vector<std::uint8_t> occupancy_bytes = occupancy_coder.finish();
  ByteWriter writer;
  writer.put(static_cast<std::uint16_t>(image.first_row / settings.tile_size));
  writer.put(static_cast<std::uint16_t>(image.rows / settings.tile_size));
  writer.put(static_cast<std::uint32_t>(occupancy_bytes.size()));
  writer.put(std::span(occupancy_bytes));
  const std::size_t before_ranges = writer.size();
  writer.put(coder.finish());
  frame.bytes = writer.take();

  frame.statistics = count_cells(image, decoded.planes);
  frame.statistics.occupancy_bits = 8.0 * static_cast<double>(occupancy_bytes.size());
  frame.statistics.plane_bits = 8.0 * static_cast<double>(plane_bytes);
  frame.statistics.residual_bits =
      8.0 * static_cast<double>(frame.bytes.size() - before_ranges) - frame.statistics.plane_bits;
  return frame;
}

Result<KeyFrame> decode_frame(const AngularGrid& grid, std::span<const std::uint8_t> bytes,
                              const FrameSettings& settings, const KeyFrame* key) {
  ByteReader reader(bytes);
  RangeImage occupancy;
  occupancy.columns = grid.columns();
  occupancy.first_row = reader.get<std::uint16_t>() * settings.tile_size;
  occupancy.rows = reader.get<std::uint16_t>() * settings.tile_size;
  const auto occupancy_bytes = reader.get(reader.get<std::uint32_t>());
  if (!reader.ok()) return Error{ErrorCode::truncated, "the frame's payload ends before its planes"};
  const std::size_t cells = occupancy.index(occupancy.rows, 0);
  if (occupancy.first_row + occupancy.rows >= grid.rows() + settings.tile_size ||
      cells > std::min(kMaxImageCells, (occupancy_bytes.size() + kLeftOutBytes) * kMaxCellsPerByte)) {
    return Error{ErrorCode::corrupt, "the frame's rows " + std::to_string(occupancy.first_row) + " + " +
                                         std::to_string(occupancy.rows) +
                                         " lie outside the grid or are more than its bytes can fill"};
  }
  occupancy.range_m.assign(cells, 0.0f);
  const Error damaged{ErrorCode::corrupt, "the frame's coded data are damaged"};

  const RangeImage* key_image = key != nullptr ? &key->image : nullptr;
  BitDecoder occupancy_coder(occupancy_bytes);
  code_occupancy(occupancy_coder, occupancy, key_image);
  if (occupancy_coder.overran()) return damaged;

  KeyFrame decoded;
  decoded.planes.layout = TileLayout(occupancy, settings.tile_size);
  decoded.planes.run_of_tile.assign(decoded.planes.layout.count(), kUnfitTile);
  BitDecoder coder(reader.rest());
  RunCoder<BitDecoder> run_coder(coder, grid, settings.tolerance.plane_step_m, key);
  if (!run_coder.code(occupancy, decoded.planes) || coder.overran()) return damaged;
  if (!render_planes(grid, occupancy, decoded.planes, decoded.image)) return damaged;
  ResidualCoder<BitDecoder>(coder, settings.residual_step_m, key_image).code(occupancy, decoded.image);
  if (coder.overran()) return damaged;
  return decoded;
}

}  // namespace pointreel
