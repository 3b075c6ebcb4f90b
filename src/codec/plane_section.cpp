#include "codec/plane_section.h"

#include <algorithm>

#include "base/simd_loops.h"
#include "codec/sections.h"
#include "planes/plane_choice.h"
#include "planes/plane_search.h"
#include "planes/plane_tiles_coding.h"

namespace pointreel {
namespace {

MovedPlanes moved(const PlaneSetting& setting, const SensorRays& rays, const EarlierPlanes* earlier) {
  if (earlier == nullptr || earlier->tiles.planes.empty()) return {};
  const SensorRays earlier_rays =
      rays_of(setting.model, earlier->grid, CodingGrid(setting.model, earlier->grid));
  return {earlier_rays, earlier->tiles, earlier->T_ref_cur, rays, TileGrid(rays.rows(), rays.columns())};
}

double plane_step_m(const PlaneSetting& setting) {
  return 0.5 * setting.max_error_m;
}

POINTREEL_SIMD_LOOPS void count_cells(const GridImage& image, const PlaneTiles& planes,
                                      FrameStatistics& statistics) {
  const TileGrid& tiles = planes.tiles;
  for (int row = 0; row < image.rows; ++row) {
    const float* range_m = &image.range_m[image.index(row, 0)];
    for (int tile = 0; tile < tiles.across; ++tile) {
      const int first = TileGrid::first_column(tile), end = tiles.end_column(tile);
      std::uint32_t returns = 0;
      if (end - first == kTileColumns) {
        for (int c = 0; c < kTileColumns; ++c) returns += range_m[first + c] > 0 ? 1 : 0;
      } else {
        for (int c = first; c < end; ++c) returns += range_m[c] > 0 ? 1 : 0;
      }
      const std::int32_t plane = planes.plane_of_tile[tiles.index(row / kTileRows, tile)];
      if (plane < 0)
        statistics.unfit_cells += returns;
      else if (planes.planes[static_cast<std::size_t>(plane)].reused)
        statistics.temporal_cells += returns;
      else
        statistics.spatial_cells += returns;
    }
  }
}

}  // namespace

SensorRays rays_of(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding) {
  std::vector<std::size_t> shifts;
  for (std::size_t row = 0; row < coding.rows(); ++row) shifts.push_back(coding.shift(row));
  return {model, grid, shifts};
}

PlaneSection encode_planes(const PlaneSetting& setting, const EarlierPlanes* earlier, const GridImage& image,
                           const GridImage& tolerance_m, ByteWriter& writer, FrameStatistics& statistics) {
  const SensorRays rays = rays_of(setting.model, setting.grid, setting.coding);
  const MovedPlanes moved_planes = moved(setting, rays, earlier);
  PlaneSection section;
  section.tiles =
      find_planes({rays, image.range_m, tolerance_m.range_m, plane_step_m(setting), moved_planes});
  if (setting.stage == PlaneStage::where_it_pays)
    drop_dear_planes(image.range_m, 2 * setting.max_error_m, section.tiles);
  const auto bytes = encode_plane_tiles(rays, plane_step_m(setting), moved_planes, section.tiles);
  put_section(writer, bytes);
  section.range_m = ranges_on_planes_m(rays, section.tiles, setting.threads);
  statistics.plane_bits += bits_of(bytes.size());
  statistics.runs += static_cast<std::uint32_t>(section.tiles.planes.size());
  count_cells(image, section.tiles, statistics);
  return section;
}

Result<PlaneTiles> decode_planes(const PlaneSetting& setting, const SensorRays& rays,
                                 const EarlierPlanes* earlier, ByteReader& reader) {
  const auto bytes = get_section(reader);
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its planes"};
  return decode_plane_tiles(rays, plane_step_m(setting), moved(setting, rays, earlier), bytes);
}

}  // namespace pointreel
