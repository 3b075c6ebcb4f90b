// The geometry of a sweep on its sensor's grid, as bytes: the core of method `mixture`.
//
//   cells -> planes -> code bands -> order -> verify every point, correct those that miss -> strays
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "base/raw_vector.h"
#include "codec/image_sections.h"
#include "codec/plane_section.h"
#include "codec/sweep_cells.h"
#include "pointreel/codec.h"
#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// What both sides know of a sweep's points once its geometry is coded; one entry a point, in output order.
struct CodedGeometry {
  std::uint32_t rows = 0, columns = 0;    // of the coding image; 0 when there is none
  RawVector<std::int32_t> cell_of_point;  // in the image; -1: off the grid
  RawVector<float> range_m;               // decoded, along the ray; 0 off the grid
  bool order_kept = true;
  std::vector<std::uint32_t> bursts;  // sizes, where the output order has yet to be sorted by them
};

// What the next sweep can be predicted from.
struct CodedImage {
  ReferenceSweep reference;  // empty for a sweep without a grid
  PlaneTiles planes;         // of method `planes`
};

// What both sides know of the sensor and the stream.
struct GeometrySetting {
  const SensorModel& model;
  double max_error_m;
  Effort effort;
  int threads;
  PlaneStage planes;
  WarpMemory& warp_memory;  // of the stream
};

GeometrySetting geometry_setting(const StreamHeader& header, const SensorModel& model, int threads,
                                 WarpMemory& warp_memory);

// Those of a prediction, if there is one.
std::optional<EarlierPlanes> earlier_planes(const std::optional<Prediction>& prediction);

struct EncodedGeometry {
  CodedGeometry geometry;
  CodedImage image;
  std::vector<std::uint32_t> output_order;  // index in the input of each output point
};

// All points of `cloud` must be finite. `sweep`: its projection; `sweep_cells`: its cells. `bursts`: those of
// the sort that was undone, if one was (sensor/burst_sort.h). `prediction`: nullptr for a frame by itself;
// its pose is rounded for the stream. Appends to `writer`.
EncodedGeometry encode_gridded(const GeometrySetting& setting, const PointCloud& cloud, GriddedSweep sweep,
                               SweepCells sweep_cells, std::span<const std::uint32_t> bursts,
                               const Prediction* prediction, ByteWriter& writer, FrameStatistics& statistics);

struct DecodedGeometry {
  CodedGeometry geometry;
  CodedImage image;
  std::vector<Point3f> positions;
};

// `reference`: nullptr for a frame by itself. Error: truncated or corrupt; also when there are not
// `points_out` points.
Result<DecodedGeometry> decode_gridded(const GeometrySetting& setting, std::size_t points_out,
                                       const CodedImage* reference, ByteReader& reader);

// The planes of a sweep and the grid that they are on.
struct GriddedPlanes {
  SweepGrid grid;
  PlaneTiles tiles;
};

// Leaves the ranges where they are. Only for a setting with planes. Error: truncated or corrupt.
Result<GriddedPlanes> decode_gridded_planes(const GeometrySetting& setting, const GriddedPlanes* reference,
                                            ByteReader& reader);

}  // namespace pointreel
