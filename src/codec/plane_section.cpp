#include "codec/plane_section.h"

#include "codec/sections.h"
#include "planes/plane_choice.h"
#include "planes/plane_search.h"
#include "planes/plane_tiles_coding.h"

namespace pointreel {
namespace {

SensorRays rays_of(const PlaneSetting& setting) {
  std::vector<std::size_t> shifts;
  for (std::size_t row = 0; row < setting.coding.rows(); ++row) shifts.push_back(setting.coding.shift(row));
  return SensorRays(setting.model, setting.grid, shifts);
}

double plane_step_m(const PlaneSetting& setting) {
  return 0.5 * setting.max_error_m;
}
}  // namespace

PlaneSection encode_planes(const PlaneSetting& setting, const GridImage& image, const GridImage& tolerance_m,
                           ByteWriter& writer, FrameStatistics& statistics) {
  const SensorRays rays = rays_of(setting);
  PlaneSection section;
  section.tiles = find_planes({rays, image.range_m, tolerance_m.range_m, plane_step_m(setting)});
  if (setting.stage == PlaneStage::where_it_pays)
    drop_dear_planes(image.range_m, 2 * setting.max_error_m, section.tiles);
  const auto bytes = encode_plane_tiles(rays, plane_step_m(setting), section.tiles);
  put_section(writer, bytes);
  section.range_m = ranges_on_planes_m(rays, section.tiles, setting.threads);
  statistics.plane_bits += bits_of(bytes.size());
  statistics.runs += static_cast<std::uint32_t>(section.tiles.planes.size());
  for (std::size_t cell = 0; cell < image.range_m.size(); ++cell) {
    if (!(image.range_m[cell] > 0)) continue;
    ++(section.range_m[cell] > 0 ? statistics.spatial_cells : statistics.unfit_cells);
  }
  return section;
}

Result<PlaneSection> decode_planes(const PlaneSetting& setting, ByteReader& reader) {
  const SensorRays rays = rays_of(setting);
  auto tiles = decode_plane_tiles(rays, plane_step_m(setting), get_section(reader));
  if (!tiles) return tiles.error();
  PlaneSection section{*std::move(tiles), {}};
  section.range_m = ranges_on_planes_m(rays, section.tiles, setting.threads);
  return section;
}

}  // namespace pointreel
