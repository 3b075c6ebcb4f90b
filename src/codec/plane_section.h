// The planes of a sweep on its sensor's grid as a section of its payload: method `planes`.
#pragma once

#include <cstdint>
#include <vector>

#include "base/bytes.h"
#include "planes/plane_tiles.h"
#include "pointreel/codec.h"
#include "pointreel/motion.h"
#include "predict/coding_grid.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// Whether cells are given planes before the others are coded.
enum class PlaneStage : std::uint8_t {
  none,              // method `mixture`
  wherever_it_fits,  // every tile whose points all lie on one, within the bound
  where_it_pays      // those whose planes take fewer bits than their points would
};

struct PlaneSetting {
  const SensorModel& model;
  const SweepGrid& grid;
  const CodingGrid& coding;
  double max_error_m;
  int threads;
  PlaneStage stage;
};

struct PlaneSection {
  PlaneTiles tiles;
  std::vector<float> range_m;  // by cell of the image: on the planes, 0 elsewhere
};

// The planes that a predicted frame may use again, and the motion since.
struct EarlierPlanes {
  const SweepGrid& grid;
  const PlaneTiles& tiles;
  Pose T_ref_cur;
};

SensorRays rays_of(const SensorModel& model, const SweepGrid& grid, const CodingGrid& coding);

// `earlier`: nullptr for a frame by itself. `tolerance_m`: by how much each range may be off.
PlaneSection encode_planes(const PlaneSetting& setting, const EarlierPlanes* earlier, const GridImage& image,
                           const GridImage& tolerance_m, ByteWriter& writer, FrameStatistics& statistics);

// Without the ranges. Error: truncated.
Result<PlaneTiles> decode_planes(const PlaneSetting& setting, const SensorRays& rays,
                                 const EarlierPlanes* earlier, ByteReader& reader);

}  // namespace pointreel
