#include "codec/plane_section.h"

#include "codec/sections.h"
#include "planes/plane_choice.h"
#include "planes/plane_search.h"
#include "planes/plane_tiles_coding.h"

namespace pointreel {
namespace {

SensorRays rays_of(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding) {
  std::vector<std::size_t> shifts;
  for (std::size_t row = 0; row < coding.rows(); ++row) shifts.push_back(coding.shift(row));
  return SensorRays(model, grid, shifts);
}

MovedPlanes earlier_planes(const PlaneSetting& setting, const SensorRays& rays,
                           const Prediction* prediction) {
  if (prediction == nullptr || prediction->planes.planes.empty()) return {};
  const SweepGrid& grid = prediction->reference.grid;
  const SensorRays reference_rays = rays_of(setting.model, grid, CodingGrid(setting.model, grid));
  return MovedPlanes(reference_rays, prediction->planes, prediction->T_ref_cur, rays,
                     TileGrid(rays.rows(), rays.columns()));
}

double plane_step_m(const PlaneSetting& setting) {
  return 0.5 * setting.max_error_m;
}
void count_cells(const GridImage& image, const PlaneTiles& planes, FrameStatistics& statistics) {
  for (int row = 0; row < image.rows; ++row) {
    const std::int32_t* plane_of_tile = &planes.plane_of_tile[planes.tiles.index(row / kTileRows, 0)];
    for (int column = 0; column < image.columns; ++column) {
      if (!(image.range_m[image.index(row, column)] > 0)) continue;
      const std::int32_t plane = plane_of_tile[column / kTileColumns];
      if (plane < 0)
        ++statistics.unfit_cells;
      else
        ++(planes.planes[static_cast<std::size_t>(plane)].reused ? statistics.temporal_cells
                                                                 : statistics.spatial_cells);
    }
  }
}

}  // namespace

PlaneSection encode_planes(const PlaneSetting& setting, const Prediction* prediction, const GridImage& image,
                           const GridImage& tolerance_m, ByteWriter& writer, FrameStatistics& statistics) {
  const SensorRays rays = rays_of(setting.model, setting.grid, setting.coding);
  const MovedPlanes earlier = earlier_planes(setting, rays, prediction);
  PlaneSection section;
  section.tiles = find_planes({rays, image.range_m, tolerance_m.range_m, plane_step_m(setting), earlier});
  if (setting.stage == PlaneStage::where_it_pays)
    drop_dear_planes(image.range_m, 2 * setting.max_error_m, section.tiles);
  const auto bytes = encode_plane_tiles(rays, plane_step_m(setting), earlier, section.tiles);
  put_section(writer, bytes);
  section.range_m = ranges_on_planes_m(rays, section.tiles, setting.threads);
  statistics.plane_bits += bits_of(bytes.size());
  statistics.runs += static_cast<std::uint32_t>(section.tiles.planes.size());
  count_cells(image, section.tiles, statistics);
  return section;
}

Result<PlaneSection> decode_planes(const PlaneSetting& setting, const Prediction* prediction,
                                   ByteReader& reader) {
  const SensorRays rays = rays_of(setting.model, setting.grid, setting.coding);
  const MovedPlanes earlier = earlier_planes(setting, rays, prediction);
  auto tiles = decode_plane_tiles(rays, plane_step_m(setting), earlier, get_section(reader));
  if (!tiles) return tiles.error();
  PlaneSection section{*std::move(tiles), {}};
  section.range_m = ranges_on_planes_m(rays, section.tiles, setting.threads);
  return section;
}

}  // namespace pointreel
