#include "codec/plane_section.h"

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

struct CellCounts {
  std::uint32_t on_planes = 0, on_none = 0;
};

// Of those with a return, by whether a plane says where.
POINTREEL_SIMD_LOOPS CellCounts count_cells(const float* range_m, const float* on_plane_m,
                                            std::size_t cells) {
  CellCounts counts;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::uint32_t returns = range_m[cell] > 0 ? 1 : 0, on_plane = on_plane_m[cell] > 0 ? 1 : 0;
    counts.on_planes += returns & on_plane;
    counts.on_none += returns & (on_plane ^ 1);
  }
  return counts;
}

std::uint32_t cells_on_reused(const GridImage& image, const PlaneTiles& planes) {
  const TileGrid& tiles = planes.tiles;
  std::uint32_t cells = 0;
  for (int tile_row = 0; tile_row < tiles.down; ++tile_row) {
    for (int tile = 0; tile < tiles.across; ++tile) {
      const std::int32_t plane = planes.plane_of_tile[tiles.index(tile_row, tile)];
      if (plane < 0 || !planes.planes[static_cast<std::size_t>(plane)].reused) continue;
      for (int row = TileGrid::first_row(tile_row); row < tiles.end_row(tile_row); ++row) {
        for (int column = TileGrid::first_column(tile); column < tiles.end_column(tile); ++column)
          cells += image.range_m[image.index(row, column)] > 0 ? 1 : 0;
      }
    }
  }
  return cells;
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
  const CellCounts counts = count_cells(image.range_m.data(), section.range_m.data(), image.range_m.size());
  const std::uint32_t reused = cells_on_reused(image, section.tiles);
  statistics.unfit_cells += counts.on_none;
  statistics.temporal_cells += reused;
  statistics.spatial_cells += counts.on_planes - reused;
  return section;
}

Result<PlaneTiles> decode_planes(const PlaneSetting& setting, const SensorRays& rays,
                                 const EarlierPlanes* earlier, ByteReader& reader) {
  const auto bytes = get_section(reader);
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its planes"};
  return decode_plane_tiles(rays, plane_step_m(setting), moved(setting, rays, earlier), bytes);
}

}  // namespace pointreel
